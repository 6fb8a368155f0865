#include "route_search.hpp"

#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/fmt/FMT.h>
#include <ompl/util/Console.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"

namespace vigia::planner {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Eigen::Vector2d;
using Space = ob::RealVectorStateSpace;

Vector2d point_of(const ob::State* state) {
  const auto* values = state->as<Space::StateType>()->values;
  return {values[0], values[1]};
}

/// Places on a ring round @p centre at which the disc fits.
void append_ring(const RoomToMove& room, const Vector2d& centre, double radius_m,
                 std::vector<Vector2d>& places) {
  constexpr int kDirections = 16;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * kPi * k / kDirections;
    const Vector2d p = centre + 1.02 * radius_m * unit_vector(angle);
    if (room.fits(p)) places.push_back(p);
  }
}

/// Places just free of the ends of the faces and of the obstacles: a shortest route turns there,
/// and passages lie between them.
std::vector<Vector2d> places_round_corners(const RoomToMove& room) {
  std::vector<Vector2d> result;
  for (const Wall& face : room.plan().faces())
    for (const Vector2d& end : {face.a, face.b}) append_ring(room, end, room.radius(), result);
  for (const RoundObstacle& other : room.others())
    append_ring(room, other.centre, room.radius() + other.radius_m, result);
  return result;
}

/// First the given places, then uniformly drawn ones. OMPL's own samplers draw from generators
/// whose seeds depend on everything that used OMPL before in the process.
class SeededSampler : public ob::StateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, std::vector<Vector2d> places, std::uint64_t seed)
      : ob::StateSampler(space), places_(std::move(places)), stream_(seed, "route") {}

  void sampleUniform(ob::State* state) override {
    const ob::RealVectorBounds& bounds = space_->as<Space>()->getBounds();
    double* values = state->as<Space::StateType>()->values;
    if (next_ < places_.size()) {
      values[0] = places_[next_].x();
      values[1] = places_[next_].y();
      ++next_;
      return;
    }
    for (unsigned i = 0; i < 2; ++i) values[i] = stream_.uniform(bounds.low[i], bounds.high[i]);
  }
  // FMT* asks for uniform samples only; the interface wants all three.
  void sampleUniformNear(ob::State* state, const ob::State*, double) override {
    sampleUniform(state);
  }
  void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }

 private:
  std::vector<Vector2d> places_;
  std::size_t next_ = 0;
  RandomStream stream_;
};

class ExactMotions : public ob::MotionValidator {
 public:
  ExactMotions(const ob::SpaceInformationPtr& information, const RoomToMove& room)
      : ob::MotionValidator(information), room_(room) {}

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return room_.passes(point_of(a), point_of(b));
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    const bool passes = checkMotion(a, b);
    last_valid.second = passes ? 1.0 : 0.0;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, passes ? b : a);
    return passes;
  }

 private:
  RoomToMove room_;
};

ob::SpaceInformationPtr make_space(const RoomToMove& room, std::uint64_t seed) {
  auto space = std::make_shared<Space>(2);
  ob::RealVectorBounds bounds(2);
  for (unsigned i = 0; i < 2; ++i) {
    bounds.setLow(i, room.plan().min_corner()[i]);
    bounds.setHigh(i, room.plan().max_corner()[i]);
  }
  space->setBounds(bounds);
  space->setStateSamplerAllocator(
      [places = places_round_corners(room), seed](const ob::StateSpace* s) {
        return std::make_shared<SeededSampler>(s, places, seed);
      });
  auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker(
      [room](const ob::State* state) { return room.fits(point_of(state)); });
  information->setMotionValidator(std::make_shared<ExactMotions>(information, room));
  information->setup();
  return information;
}

void silence_ompl() {
  static std::once_flag once;
  std::call_once(once, [] { ompl::msg::noOutputHandler(); });
}

}  // namespace

std::vector<Vector2d> search_route(const RoomToMove& room, const Vector2d& start,
                                   const Vector2d& goal, int samples, std::uint64_t seed) {
  silence_ompl();
  const auto information = make_space(room, seed);
  ob::ScopedState<Space> start_state(information);
  ob::ScopedState<Space> goal_state(information);
  for (unsigned i = 0; i < 2; ++i) {
    start_state[i] = start[i];
    goal_state[i] = goal[i];
  }
  auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setStartAndGoalStates(start_state, goal_state);
  problem->setOptimizationObjective(
      std::make_shared<ob::PathLengthOptimizationObjective>(information));

  og::FMT planner(information);
  planner.setNumSamples(static_cast<unsigned>(samples));
  // One batch: extending it has no end but the clock where there is no route.
  planner.setExtendedFMT(false);
  planner.setProblemDefinition(problem);
  planner.setup();
  const ob::PlannerStatus status = planner.solve(ob::plannerNonTerminatingCondition());
  if (status != ob::PlannerStatus::EXACT_SOLUTION) return {};

  std::vector<Vector2d> result;
  for (const ob::State* state : problem->getSolutionPath()->as<og::PathGeometric>()->getStates())
    result.push_back(point_of(state));
  return result;
}

}  // namespace vigia::planner
