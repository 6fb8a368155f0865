#include "vigia/evaluation/drive_bound.hpp"

#include "true_association.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "vigia/core/overloaded.hpp"
#include "vigia/localization/flow_fed_localizer.hpp"
#include "vigia/localization/motion_fusion.hpp"

namespace vigia::evaluation {
namespace {

std::optional<localization::CeilingFilter> ceiling_bound(const EstimatorSetup& setup) {
  if (!setup.ceiling) return std::nullopt;
  localization::CeilingFilterParams params = setup.ceiling->params;
  params.odometry = setup.odometry;
  localization::CeilingFilter bound(setup.ceiling->camera, setup.ceiling->grid, params);
  bound.reset({}, {{}, setup.prior_covariance});
  return bound;
}

std::optional<localization::CornerFilter> corner_bound(const EstimatorSetup& setup) {
  if (!setup.corners || !setup.field) return std::nullopt;
  localization::CornerFilterParams exact = *setup.corners;
  exact.odometry = setup.odometry;
  exact.gate = 1e12;  // of a corner its covariance counts, not where it is
  exact.iterations = 1;
  localization::CornerFilter bound(*setup.field, exact);
  bound.reset({}, {{}, setup.prior_covariance});
  return bound;
}

}  // namespace

DriveBound::DriveBound(const EstimatorSetup& setup)
    : setup_(setup),
      states_{PosteriorBound(setup.prior_covariance, setup.on_ground, setup.sensor),
              ceiling_bound(setup),
              corner_bound(setup),
              false,
              {}} {
  if (setup_.field) field_.emplace(*setup_.field);
}

void DriveBound::States::move(const Move& move, const EstimatorSetup& setup) {
  if (move.flow && setup.ceiling) {
    follow(move, setup);
    return;
  }
  move_looks_and_corners(move, setup.odometry);
  if (!ceiling) return;
  ceiling->place({move.before, {}, {}});
  ceiling->predict(move.u);
}

void DriveBound::States::move_looks_and_corners(const Move& move, const OdometryNoise& odometry) {
  looks.predict(move.before, move.u, control_covariance(move.u, odometry));
  if (corners) {
    corners->relinearise(move.before);
    corners->predict(move.u);
  }
}

void DriveBound::States::follow(Move move, const EstimatorSetup& setup) {
  localization::CeilingFilterParams params = setup.ceiling->params;
  params.odometry = setup.odometry;
  if (ceiling) {
    ceiling->place({move.before, {}, {}});
    ceiling->predict(move.u, *move.flow);
  }
  if (const auto refined = localization::joined_with_flow(move.parts, *move.flow,
                                                          setup.ceiling->camera, params, trust))
    move.u = *refined;
  move_looks_and_corners(move, setup.odometry);
}

Eigen::Matrix3d DriveBound::States::covariance() const {
  if (by_landmarks) return looks.covariance();
  if (corners) return corners->belief().covariance;
  return ceiling ? ceiling->belief().covariance : looks.covariance();
}

void DriveBound::move(const Pose2& before, const OdometryIncrement& u) {
  now_ = std::max(now_, u.to);
  steps_.emplace_back(Move{before, u, {}, std::nullopt});
  settle();
}

void DriveBound::learn(const Observation& observation, const mission::ExposureTruth& truth) {
  if (const auto* flow = std::get_if<FlowObservation>(&observation)) {
    if (follows_flow()) join(*flow);
  } else if (auto teach = lesson(observation, truth)) {
    insert({shot_of(observation).stamp, std::move(teach)});
  }
  settle();
}

/// The motions between the flow's frames become one, by odometry and flow.
void DriveBound::join(const FlowObservation& flow) {
  const auto is_first = [&](const Step& step) {
    const auto* move = std::get_if<Move>(&step);
    return move != nullptr && !move->flow && move->u.from == flow.from;
  };
  const auto first = std::find_if(steps_.begin(), steps_.end(), is_first);
  std::vector<OdometryIncrement> parts;
  auto last = first;
  for (; last != steps_.end(); ++last) {
    const auto* move = std::get_if<Move>(&*last);
    if (move == nullptr || move->flow || flow.shot.stamp < move->u.to) break;
    parts.push_back(move->u);
  }
  if (parts.empty()) return;
  Move whole{std::get<Move>(*first).before, localization::joined(parts), parts, std::nullopt};
  whole.flow = localization::seen_shift(setup_.ceiling->camera, vigia::move({}, whole.u));
  whole.flow->covariance = flow.shift.covariance;
  *first = std::move(whole);
  steps_.erase(std::next(first), last);
}

/// What an image teaches; nothing where it shows nothing that is modelled.
std::function<void(DriveBound::States&)> DriveBound::lesson(
    const Observation& observation, const mission::ExposureTruth& truth) const {
  if (const auto* seen = std::get_if<FieldObservation>(&observation); seen && field_) {
    // Of the points as they truly lie: on the map's lines or by chance.
    const Eigen::Matrix3d information =
        field_->linearise(seen->scan.points, truth.pose, field_->params().clutter).complete;
    return [information](States& states) { states.looks.update(information); };
  }
  if (const auto* seen = std::get_if<PatchesObservation>(&observation); seen && states_.ceiling)
    return [pose = truth.pose, patches = seen->patches](States& states) {
      states.ceiling->inform({pose, {}, {}}, patches);
    };
  if (const auto* seen = std::get_if<StereoObservation>(&observation); seen && states_.corners)
    return [pose = truth.pose, corners = seen->corners](States& states) {
      states.corners->relinearise(pose);
      states.corners->update(corners);
    };
  const Landmark* landmark =
      true_landmark(observation, setup_.landmarks, setup_.on_ground, truth.pose, truth.bias);
  if (landmark == nullptr) return {};
  return [truth, shown = *landmark, observation](States& states) {
    states.by_landmarks = true;
    states.looks.update(truth.pose, truth.bias, shown, observation);
  };
}

/// After the motion in which it was exposed, and what was exposed before it.
void DriveBound::insert(Image image) {
  now_ = std::max(now_, image.stamp);
  const auto is_later = [&](const Step& step) {
    return std::visit(Overloaded{[&](const Move& move) { return image.stamp <= move.u.from; },
                                 [&](const Image& other) { return image.stamp < other.stamp; }},
                      step);
  };
  steps_.insert(std::find_if(steps_.begin(), steps_.end(), is_later), std::move(image));
}

/// Whether no image comes any more that was exposed before the step's end.
bool DriveBound::is_settled(const Step& step) const {
  const Stamp end = std::visit(Overloaded{[](const Move& move) { return move.u.to; },
                                          [](const Image& image) { return image.stamp; }},
                               step);
  return end <= now_ - setup_.longest_delay;
}

/// What is settled goes into the states. A motion that a flow may join goes when the next step
/// does.
void DriveBound::settle() {
  auto settled = steps_.begin();
  for (auto step = steps_.begin(); step != steps_.end() && is_settled(*step); ++step) {
    const auto* move = std::get_if<Move>(&*step);
    const bool waits = follows_flow() && move != nullptr && !move->flow;
    if (!waits) settled = std::next(step);
  }
  for (auto step = steps_.begin(); step != settled; ++step) apply(*step, states_);
  steps_.erase(steps_.begin(), settled);
}

void DriveBound::apply(const Step& step, States& states) const {
  std::visit(Overloaded{[&](const Move& move) { states.move(move, setup_); },
                        [&](const Image& image) { image.teach(states); }},
             step);
}

Eigen::Matrix3d DriveBound::covariance() const {
  if (steps_.empty()) return states_.covariance();
  States ahead = states_;
  for (const Step& step : steps_) apply(step, ahead);
  return ahead.covariance();
}

}  // namespace vigia::evaluation
