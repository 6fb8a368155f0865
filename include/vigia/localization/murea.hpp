#pragma once

#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/localization/field_model.hpp"

namespace vigia::localization {

struct MureaParams {
  double coarse_m = 0.8;     ///< side of the first cells
  double coarse_deg = 20.0;  ///< and their span of headings
  double cell_m = 0.05;      ///< refined until a cell's side is at most this …
  double cell_deg = 1.25;    ///< … and its span of headings this
  /// A perception votes for a cell when it lies so many σ or less from what the cell allows.
  double tolerance_sigmas = 2.0;
  /// Votes that a goal or post has, which tells more than a line point: those of the two halves of
  /// a field differ in nothing else.
  double sighting_votes = 5.0;
  /// A cell's share in the answer falls by this factor's exponential a vote below the best.
  double vote_gain = 0.5;
  /// Covariance of the answer by that of the cells so weighed, times vote_gain: fitted to the
  /// errors of 50 points without clutter.
  double error_share = 0.2;
  /// Cells with at least this share of the greatest number of votes are refined …
  double keep_share = 0.8;
  /// … but no more than so many at each resolution.
  int keep_cells = 600;
  /// How many cells may be voted for: the answer is coarser where that is not enough (any-time).
  int cell_budget = 200000;
};

/// A cell of the space of poses.
struct MureaCell {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< x, y, θ
  double votes = 0.0;
};

struct MureaFix {
  bool found = false;
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the winning cells' spread
  double votes = 0.0;                                    ///< of the best cell
  double runner_up = 0.0;  ///< votes of the best cell farther than half a metre or 20° …
  Pose2 second;            ///< … and its middle
  double cell_m = 0.0;     ///< resolution reached
  double cell_deg = 0.0;
  int levels = 0;
  int cells = 0;  ///< voted for
};

/// MUREA (Restelli, Sorrenti, Marchese): multi-resolution evidence accumulation. Every perception –
/// line point, goal, post – votes for the cells of (x, y, θ) that it is compatible with, given the
/// map: one vote when it agrees with the cell's middle, less and less up to none where no pose of
/// the cell allows it. The cells with most votes are divided by two in every dimension, and so on.
class Murea {
 public:
  explicit Murea(const FieldModel& model, const MureaParams& params = {});

  /// Global over the whole field, local within 3σ of an @p estimate.
  MureaFix locate(const FieldScan& scan, const std::optional<Prior>& estimate = std::nullopt) const;

 private:
  const FieldModel* model_;
  MureaParams params_;
  FieldDistance wide_;  ///< for large cells
};

struct MureaLocalizerParams {
  MureaParams murea;
  OdometryNoise odometry;
  /// The estimate counts as lost, and the search is global, after so many scans in a row whose
  /// votes fall below this share of what is usual.
  int fewer_votes_in_a_row = 2;
  double usual_share = 0.8;
  /// A pose is ambiguous when another place has this share of its votes.
  double ambiguous_share = 0.9;
  int check_every = 25;  ///< scans between two global searches while all is well
};

/// MUREA in time: local about the last pose moved by odometry while it agrees with the scans,
/// global at the start and after.
class MureaLocalizer {
 public:
  MureaLocalizer(const FieldModel& model, const MureaLocalizerParams& params);

  void reset(Stamp stamp, const std::optional<Prior>& prior);
  void predict(const OdometryIncrement& increment);
  void update(const FieldScan& scan);
  const Belief& belief() const { return belief_; }

 private:
  void accept(const MureaFix& fix, bool global);
  bool votes_have_fallen(const MureaFix& fix, const FieldScan& scan);

  MureaLocalizerParams params_;
  Murea murea_;
  std::optional<Prior> estimate_;
  std::optional<double> usual_;  ///< votes a perception
  int fewer_votes_ = 0;
  int since_global_ = 0;
  Belief belief_;
};

}  // namespace vigia::localization
