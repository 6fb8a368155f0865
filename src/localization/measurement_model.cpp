#include "vigia/localization/measurement_model.hpp"

#include <utility>

#include "vigia/core/line_of_sight.hpp"
#include "vigia/localization/chi_square.hpp"

namespace vigia::localization {

const Shot& shot_of(const Match& match) {
  return std::visit([](const auto& one) -> const Shot& { return one.shot; }, match);
}

MeasurementModel::MeasurementModel(LandmarkMap map, const RigOnGround& on_ground,
                                   const MeasurementParams& params, std::optional<FloorPlan> plan)
    : map_(std::move(map)), on_ground_(on_ground), params_(params), plan_(std::move(plan)) {
  for (int dof = 1; dof <= kTabledDof; ++dof)
    gates_[static_cast<std::size_t>(dof)] = chi_square_quantile(params.gate_probability, dof);
}

Association MeasurementModel::associate(const Observation& observation,
                                        const LookState& state) const {
  const auto image = landmark_image(observation);
  if (!image) return {};
  return std::visit(
      [&](const auto* seen) {
        auto found = localization::associate(*this, *seen, state);
        Association association{found.result, std::nullopt};
        if (found.match) association.match = *std::move(found.match);
        return association;
      },
      *image);
}

std::optional<Match> MeasurementModel::match(const Observation& observation,
                                             const Landmark& landmark) const {
  const auto image = landmark_image(observation);
  if (!image) return std::nullopt;
  return std::visit(
      [&](const auto* seen) -> std::optional<Match> {
        return localization::match(*this, *seen, landmark);
      },
      *image);
}

std::optional<double> MeasurementModel::log_likelihood(const Observation& observation,
                                                       const Pose2& pose) const {
  const auto image = landmark_image(observation);
  if (!image) return std::nullopt;
  return std::visit(
      [&](const auto* seen) { return localization::log_likelihood(*this, *seen, pose); }, *image);
}

Eigen::Array3d MeasurementModel::look_biases(CameraId camera) const {
  const Camera& seen_by = on_ground_.rig.at(camera);
  if (!on_head(seen_by)) return Eigen::Array3d::Zero();
  return {1.0, 1.0, std::holds_alternative<ZoomCalibration>(seen_by.optics) ? 1.0 : 0.0};
}

bool MeasurementModel::hides(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w) const {
  return plan_ && !line_of_sight(*plan_, on_ground_.ground, from_w, to_w);
}

double MeasurementModel::gate(int dof) const {
  if (dof < 1 || dof > kTabledDof) return chi_square_quantile(params_.gate_probability, dof);
  return gates_[static_cast<std::size_t>(dof)];
}

}  // namespace vigia::localization
