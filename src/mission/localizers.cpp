#include "vigia/mission/localizers.hpp"

#include "localizer_params.hpp"
#include "robot_parts.hpp"

#include <algorithm>

#include "vigia/core/random.hpp"
#include "vigia/localization/ceiling_localizer.hpp"
#include "vigia/localization/ekf.hpp"
#include "vigia/localization/field_localizer.hpp"
#include "vigia/localization/flow_fed_localizer.hpp"
#include "vigia/localization/ml_fix_localizer.hpp"
#include "vigia/localization/odometry_localizer.hpp"
#include "vigia/localization/pattern_fix.hpp"
#include "vigia/localization/running_fix_localizer.hpp"
#include "vigia/mission/delays.hpp"

namespace vigia::mission {
namespace {

using LocalizerPtr = std::unique_ptr<localization::Localizer>;

bool anywhere(const MissionSetup&) {
  return true;
}

bool has_landmarks(const MissionSetup& setup) {
  return !setup.world.landmarks.all().empty();
}

bool has_eye(const MissionSetup& setup, std::string_view eye) {
  const Rig rig = setup.robot.rig();
  return std::any_of(rig.cameras.begin(), rig.cameras.end(),
                     [&](const Camera& camera) { return eye_of(camera, setup.world, rig) == eye; });
}

/// A field, and an eye that scans it.
bool has_field(const MissionSetup& setup) {
  return setup.world.field && has_eye(setup, "field");
}

/// Landmarks, and an eye that finds them.
bool sees_landmarks(const MissionSetup& setup) {
  return has_landmarks(setup) && has_eye(setup, "landmark");
}

bool has_ceiling(const MissionSetup& setup) {
  return ceiling_camera(setup).has_value();
}

bool has_corners(const MissionSetup& setup) {
  return corner_filter_params(setup).has_value();
}

bool has_patterns(const MissionSetup& setup) {
  const auto& landmarks = setup.world.landmarks.all();
  return std::any_of(landmarks.begin(), landmarks.end(), [](const Landmark& landmark) {
    return std::holds_alternative<PatternShape>(landmark.shape);
  });
}

constexpr const char* kNeedsPair =
    "a field with goals in the world, and a level stereo pair: two cameras, the left one first, "
    "alike in place, lens and timing";

LocalizerPtr make_ekf(const MissionSetup& setup, std::uint64_t /*seed*/) {
  return std::make_unique<localization::EkfLocalizer>(setup.world.landmarks, setup.on_ground(),
                                                      setup.ekf, setup.world.plan);
}

LocalizerPtr make_odometry(const MissionSetup& setup, std::uint64_t /*seed*/) {
  return std::make_unique<localization::OdometryLocalizer>(setup.noise.odometry);
}

LocalizerPtr make_pattern_fix(const MissionSetup& setup, std::uint64_t /*seed*/) {
  return std::make_unique<localization::PatternFixLocalizer>(
      setup.world.landmarks, setup.on_ground(), pattern_fix_params(setup));
}

/// The calibration of a robot's mirror is never quite right: its errors are estimated.
localization::MirrorOfRig mirror_of(const MissionSetup& setup) {
  return {setup.robot.rig(), {}};
}

LocalizerPtr make_field_grid(const MissionSetup& setup, std::uint64_t /*seed*/) {
  localization::FieldTrackerParams params;
  params.odometry = setup.noise.odometry;
  return localization::make_field_tracker(setup.world.field.value_or(FieldMap{}), params,
                                          mirror_of(setup));
}

LocalizerPtr make_mcl(const MissionSetup& setup, std::uint64_t seed) {
  localization::MclParams params;
  params.odometry = setup.noise.odometry;
  return localization::make_mcl(setup.world.field.value_or(FieldMap{}), params,
                                derive_seed(seed, "mcl"), mirror_of(setup));
}

LocalizerPtr make_murea(const MissionSetup& setup, std::uint64_t /*seed*/) {
  localization::MureaLocalizerParams params;
  params.odometry = setup.noise.odometry;
  return localization::make_murea(setup.world.field.value_or(FieldMap{}), params, mirror_of(setup));
}

LocalizerPtr make_ceiling(const MissionSetup& setup, std::uint64_t /*seed*/) {
  return std::make_unique<localization::CeilingLocalizer>(
      ceiling_camera(setup).value_or(localization::CeilingCamera{}),
      setup.world.ceiling.value_or(CeilingGrid{}), setup.ceiling, moved_by_flow(setup, "ceiling"));
}

LocalizerPtr make_running_fix(const MissionSetup& setup, std::uint64_t /*seed*/) {
  localization::RunningFixLocalizerParams params;
  params.pair = corner_filter_params(setup).value_or(localization::CornerFilterParams{});
  return std::make_unique<localization::RunningFixLocalizer>(setup.world.field.value_or(FieldMap{}),
                                                             params);
}

LocalizerPtr make_ml_fix(const MissionSetup& setup, std::uint64_t /*seed*/) {
  localization::MlFixParams params;
  params.filter = corner_filter_params(setup).value_or(localization::CornerFilterParams{});
  return std::make_unique<localization::MlFixLocalizer>(setup.world.field.value_or(FieldMap{}),
                                                        params);
}

LocalizerPtr make_bearing_only(const MissionSetup& setup, std::uint64_t /*seed*/) {
  return std::make_unique<localization::BearingOnlyLocalizer>(
      setup.world.landmarks, setup.on_ground(), setup.bearing_only, setup.world.plan);
}

Duration no_history(const MissionSetup& /*setup*/) {
  return {};
}

Duration ekf_history(const MissionSetup& setup) {
  return Duration::from_seconds(setup.ekf.history_s);
}

Duration bearing_only_history(const MissionSetup& setup) {
  return Duration::from_seconds(setup.bearing_only.history_s);
}

Duration pattern_fix_history(const MissionSetup& setup) {
  return Duration::from_seconds(pattern_fix_params(setup).history_s);
}

Duration field_history(const MissionSetup& /*setup*/) {
  return localization::FieldLocalizer::history();
}

Duration ceiling_history(const MissionSetup& /*setup*/) {
  return localization::CeilingLocalizer::history();
}

/// Until it knows where it is, it takes none that is late.
Duration ml_fix_history(const MissionSetup& setup) {
  return setup.prior ? localization::MlFixLocalizer::history() : Duration{};
}

}  // namespace

const std::vector<LocalizerEntry>& localizers() {
  static const std::vector<LocalizerEntry> table{
      {{"ekf", "extended Kalman filter on looks at discs, patterns and tags (Armingol §5)",
        "landmarks, and a camera that finds them"},
       true,
       FirstPose::recovery,
       &sees_landmarks,
       &make_ekf,
       {"landmark", &ekf_history, "localization.ekf.history_s"}},
      {{"odometry", "dead reckoning alone", "nothing"},
       true,
       FirstPose::prior,
       &anywhere,
       &make_odometry,
       {"", &no_history, ""}},
      {{"pattern_fix", "pose from one view of a colour pattern (QUIXOTE)",
        "colour patterns in the world"},
       true,
       FirstPose::itself,
       &has_patterns,
       &make_pattern_fix,
       {"landmark", &pattern_fix_history, ""}},
      {{"bearing_only", "directions to landmarks alone", "landmarks, and a camera that finds them"},
       false,
       FirstPose::looks,
       &sees_landmarks,
       &make_bearing_only,
       {"landmark", &bearing_only_history, "localization.bearing_only.history_s"}},
      {{"field_grid",
        "refined matches of a mirror camera's scans with a field's lines, followed in time as "
        "weighted hypotheses (after Minho)",
        "a field in the world, and a camera that scans it"},
       true,
       FirstPose::itself,
       &has_field,
       &make_field_grid,
       {"field", &field_history, ""}},
      {{"mcl", "Monte Carlo localization on a field's lines, goals and posts",
        "a field in the world, and a camera that scans it"},
       false,
       FirstPose::itself,
       &has_field,
       &make_mcl,
       {"field", &field_history, ""}},
      {{"murea",
        "MUREA, evidence accumulated in cells of poses that are divided further and further",
        "a field in the world, and a camera that scans it"},
       false,
       FirstPose::itself,
       &has_field,
       &make_murea,
       {"field", &field_history, ""}},
      {{"ceiling",
        "all patches of a ceiling in sight, jointly; which cell it is by motion (Chonbuk)",
        "a ceiling in the world and a fixed camera that looks up"},
       true,
       FirstPose::prior,
       &has_ceiling,
       &make_ceiling,
       {"ceiling", &ceiling_history, ""}},
      {{"running_fix",
        "a goal's corner ranged from two points of the way: two circles, the heading by odometry "
        "(Bais)",
        kNeedsPair},
       true,
       FirstPose::prior,
       &has_corners,
       &make_running_fix,
       {"stereo", &no_history, ""}},
      {{"ml_fix",
        "range and bearing of goals' corners by maximum likelihood, the errors of the pair's "
        "calibration as states (after Bais)",
        kNeedsPair},
       true,
       FirstPose::itself,
       &has_corners,
       &make_ml_fix,
       {"stereo", &ml_fix_history, ""}},
  };
  return table;
}

bool moved_by_flow(const MissionSetup& setup, const std::string& name) {
  return std::find(setup.flow.begin(), setup.flow.end(), name) != setup.flow.end();
}

LocalizerPtr make_localizer(const MissionSetup& setup, const std::string& name,
                            std::uint64_t seed) {
  LocalizerPtr made = find_name(localizers(), name)->make(setup, seed);
  const auto camera = ceiling_camera(setup);
  // The ceiling's own takes the flow as it is.
  if (!moved_by_flow(setup, name) || !camera || name == "ceiling") return made;
  return std::make_unique<localization::FlowFedLocalizer>(std::move(made), *camera, setup.ceiling);
}

std::optional<localization::CeilingCamera> ceiling_camera(const MissionSetup& setup) {
  if (!setup.world.ceiling) return std::nullopt;
  for (const sim::CameraSetup& camera : setup.robot.cameras)
    if (looks_up(camera.camera))
      return localization::CeilingCamera{camera.camera.model(0.0), camera.camera.rMc({}),
                                         setup.world.ceiling->height_m};
  return std::nullopt;
}

std::optional<localization::CornerFilterParams> corner_filter_params(const MissionSetup& setup) {
  const auto cameras = stereo_cameras(setup.robot.rig());
  if (!cameras || !setup.world.field || setup.world.field->goals.empty()) return std::nullopt;
  localization::CornerFilterParams params;
  params.pair = localization::stereo_pair(*cameras);
  params.lens = cameras->intrinsics;
  const StereoCalibrationNoise& noise = setup.noise.stereo;
  params.calibration_sigma = {noise.baseline, noise.vergence, noise.focal};
  params.odometry = setup.noise.odometry;
  return params;
}

std::vector<std::string> usual_localizers(const MissionSetup& setup) {
  const bool punctual = longest_delay(setup).ns == 0;
  std::vector<std::string> names;
  for (const LocalizerEntry& entry : localizers()) {
    const bool starts = setup.prior || !needs_prior(entry, setup);
    const bool in_time = entry.late.eye.empty() || punctual || entry.late.history(setup).ns > 0;
    if (entry.usual && starts && in_time && entry.fits(setup)) names.push_back(entry.name);
  }
  return names;
}

bool needs_prior(const LocalizerEntry& entry, const MissionSetup& setup) {
  switch (entry.first_pose) {
    case FirstPose::prior:
      return true;
    case FirstPose::recovery:
      return entry.name != setup.primary || setup.robot.directed_camera() == nullptr;
    case FirstPose::looks:
      return setup.robot.directed_camera() == nullptr;
    case FirstPose::itself:
      return false;
  }
  return true;
}

}  // namespace vigia::mission
