#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/rig.hpp"

namespace vigia::localization {

/// A sighting and what it may show.
struct Clue {
  /// A landmark that it may be, by height, and where that would stand in the base frame.
  struct Option {
    std::size_t landmark = 0;  ///< index into the map
    Eigen::Vector2d p_r = Eigen::Vector2d::Zero();
  };
  const Observation* seen = nullptr;
  double radius_px = 0.0;
  /// Of a disc, about the cosine of the angle between its normal and the line of sight; else zero.
  double aspect = 0.0;
  std::vector<Option> options;  ///< in the order of the map
  std::vector<Pose2> poses;     ///< of the robot, by a landmark that says who it is: view and twin
};

/// A sighting taken for a landmark.
struct Identification {
  std::size_t clue = 0;
  std::size_t landmark = 0;

  friend bool operator==(const Identification& a, const Identification& b) {
    return a.clue == b.clue && a.landmark == b.landmark;
  }
};

/// A pose in closed form, from a pair of sightings or from one that says who it is.
struct CandidatePose {
  Pose2 pose;
  std::vector<Identification> by;
  int support = 0;      ///< sightings that stand about where a landmark is
  double misfit = 0.0;  ///< of the pair's distance, in its tolerance
};

struct CandidatePoses {
  std::vector<CandidatePose> poses;  ///< best supported first, one a cell of place and heading
  long pairs = 0;                    ///< poses that were looked up
  bool complete = true;              ///< whether the budget let all pairs be looked up
};

/// Candidates for the place of a robot that may be anywhere. Pairs of landmarks are sorted by their
/// distance once; those that fit two sightings are looked up, kept where both landmarks face the
/// robot about as they were seen, and weighed by how many of the other sightings stand about where
/// a landmark is.
class PlaceCandidates {
 public:
  PlaceCandidates(LandmarkMap map, const RigOnGround& on_ground);

  /// What each sighting may show. Points refer to @p sightings, which outlive them.
  std::vector<Clue> clues(const std::vector<Observation>& sightings) const;
  CandidatePoses search(const std::vector<Clue>& clues, long max_pairs) const;
  /// How many sightings stand about where one of the landmarks is that they may be.
  int support(const std::vector<Clue>& clues, const Pose2& pose) const;

  /// How far a rough place at that range may be off, m.
  static double tolerance(double range_m);
  /// A landmark's place in plan coordinates.
  Eigen::Vector2d in_plan(std::size_t landmark) const { return marks_[landmark].p.head<2>(); }

 private:
  struct Mark {
    Eigen::Vector3d p;  ///< plan coordinates and height
    Eigen::Vector3d n;
    double radius_m = 0.0;  ///< of a disc
  };
  struct Pair {
    float distance_m;
    unsigned a;
    unsigned b;
  };
  struct Grid {
    Eigen::Vector2d corner = Eigen::Vector2d::Zero();
    int columns = 0;
    int rows = 0;
    std::vector<std::vector<std::size_t>> cells;

    std::size_t index(int column, int row) const {
      return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
             static_cast<std::size_t>(column);
    }
  };
  class Ballot;

  Clue disc_clue(const EllipseObservation& seen) const;
  Clue points_clue(const PointsObservation& seen) const;
  void sort_pairs();
  void fill_grid();
  bool supported(const Clue& clue, const Pose2& pose) const;
  bool faces(const Clue& clue, std::size_t landmark, const Pose2& pose) const;
  void look_up(const std::vector<Clue>& clues, std::size_t i, std::size_t j, Ballot& ballot) const;
  void look_up_discs(const std::vector<Clue>& clues, std::size_t i, std::size_t j,
                     Ballot& ballot) const;

  LandmarkMap map_;
  RigOnGround on_ground_;
  std::vector<Mark> marks_;
  std::vector<double> radii_;  ///< of the map's discs, each once
  std::vector<Pair> pairs_;    ///< of discs, by distance
  Grid grid_;
};

}  // namespace vigia::localization
