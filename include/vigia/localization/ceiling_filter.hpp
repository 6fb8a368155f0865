#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/belief.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/localization/ceiling_model.hpp"
#include "vigia/localization/flow_trust.hpp"
#include "vigia/localization/patch_motion.hpp"

namespace vigia::localization {

struct CeilingFilterParams {
  OdometryNoise odometry;
  double tilt_sigma = 0.0;    ///< rad about either axis: what the calibration leaves
  double height_sigma = 0.0;  ///< of the ceiling's distance, relative
  double gate = 16.27;        ///< χ² of a patch's three numbers
  double flow_floor = 2e-4;   ///< σ of a frame's shift beside what it claims, in ceiling distances
  double max_speed_mps = 0.3;  ///< of the robot, which is all that is known without odometry
  double sure = 0.99;          ///< a hypothesis is believed alone from this weight on
  double spurious = 0.02;      ///< chance that a patch hangs where the grid has none
  double missing = 0.05;       ///< … and that one of the grid's is not found in plain sight
  /// What patches never tell: where on the robot the camera is mounted, and its turn about its
  /// axis.
  double mount_sigma_m = 0.0;    ///< in x and in y
  double mount_yaw_sigma = 0.0;  ///< rad
  /// Frames in a row that contradict the prediction, until it is doubted. One patch alone may be
  /// none of the grid's: it counts as a frame every 0.64 s, another one beside it at once.
  int max_gated = 3;
};

/// The filter's state as it truly is.
struct CeilingTruthState {
  Pose2 pose;
  CeilingCameraErrors errors;
  /// x, y and direction of a cell's patch beside its place; 0 where nothing is said.
  std::map<CeilingCell, Eigen::Vector3d> placement;
};

/// What became of a frame's patches.
enum class CeilingUpdate {
  fused,
  none_seen,
  gated,  ///< none agrees with the grid
};

/// Extended Kalman filter under a patched ceiling: all visible patches together, odometry and
/// optical flow as motion. Beside the pose the state has what is constant: the camera's tilt and
/// height, and the placement error of every patch in view, which is forgotten when it leaves. A
/// patch's image is far more precise than what is constant is known, so that each update is
/// linearised again where it ends (iterated): the second order of a degree of heading or tilt is
/// several times the image's σ.
///
/// A patch has no identity: a fix leaves the pose open by whole cells. Each fix weighs the cells by
/// the prediction, so that where the robot may have moved by half a pitch unseen several shifts of
/// the same filter remain, weighted; the belief is then ambiguous until motion, or the edge or a
/// gap of a grid that has one, tells them apart: a patch where a shift has none, or none where it
/// has one. Where it may be anywhere, each cell of a grid with an edge is such a hypothesis; of a
/// grid without one nothing is settled any more, since cells alike are found for ever.
/// Patches without a mark leave it open by half a turn as well, where the heading was hardly known:
/// so does a hypothesis of the pose turned about a point half way between, which nothing on such a
/// grid settles.
class CeilingFilter {
 public:
  CeilingFilter(const CeilingCamera& camera, const CeilingGrid& grid,
                const CeilingFilterParams& params);

  void reset(Stamp stamp, const Prior& prior, const CeilingCameraErrors& about = {});
  void predict(const OdometryIncrement& increment);
  /// The motion between two frames by optical flow. It says nothing where it is faster than the
  /// robot can be, nor where the robot may have gone half a pitch: the patches repeat; nor where
  /// @p patches, of the frame to which it leads, moved otherwise, and from then on until some move
  /// with it again.
  void predict(const ImageShift& shift, Stamp to, const std::vector<PatchImage>& patches);
  /// By both, or where they contradict each other by the odometry alone: false.
  bool predict(const OdometryIncrement& increment, const ImageShift& shift);
  /// Nothing is known but how fast the robot may be.
  void predict_unknown(Stamp to);
  CeilingUpdate update(const std::vector<PatchImage>& patches);

  /// The cell that the mean is in is the true one, by definition.
  void take_cell_as_given();

  const Belief& belief() const { return belief_; }
  /// What is known of the camera's constant errors by now, and its covariance.
  CeilingCameraErrors camera_errors() const;
  Eigen::Matrix3d camera_errors_covariance() const;

  /// For bounds: the mean becomes the truth, at which predict() then linearises.
  void place(const CeilingTruthState& truth);
  /// For bounds: what patches teach, each of them in its true cell and linearised at the truth.
  /// Nothing is weighed, doubted or refused but what hangs where the grid has no patch.
  void inform(const CeilingTruthState& truth, const std::vector<PatchImage>& patches);

 private:
  struct Seen {
    PatchImage image;
    PatchOnCeiling patch;  ///< by the camera as it is known before the update
    bool directed;         ///< forward and backward are told apart
    CeilingCell cell;
  };
  /// y = H (truth − x) + e, e ~ N(0, R), three rows a patch.
  struct Linearised {
    Eigen::VectorXd y;
    Eigen::MatrixXd H;
    Eigen::MatrixXd R;
    Eigen::MatrixXd HP;
    Eigen::MatrixXd S;
  };
  /// Where an update ends, at which patches are linearised that are new; those whose places were
  /// learnt are where the prediction was, moved by what was unknown of the motion since.
  struct Rest {
    Eigen::VectorXd at;
    Eigen::VectorXd moved;
  };
  using Shifts = std::map<CeilingCell, double>;  ///< by whole cells, weights

  Pose2 pose() const { return Pose2::from_vector(x_.head<3>()); }
  bool wide() const;
  bool open() const;
  std::vector<Seen> see(const std::vector<PatchImage>& patches) const;
  bool follows_ceiling(const FlowMotion& flow, const std::vector<PatchImage>& patches, double dt);
  void note_contradiction(const std::vector<Seen>& seen);
  std::vector<Seen> associated(const std::vector<Seen>& seen, const Pose2& pose) const;
  /// Where an update begins, and the chance that the robot faces the other way.
  struct Start {
    Pose2 pose;
    double turned = 0.0;
    Eigen::Vector2d about = Eigen::Vector2d::Zero();  ///< half way to where it then is
  };
  Start point_of_linearisation(const std::vector<Seen>& seen) const;
  /// Patches with the cells that the start gives them, and those of them that the prediction
  /// allows.
  struct Fit {
    Start start;
    std::vector<Seen> seen;
    std::vector<Seen> passed;
  };
  Fit fit(const std::vector<Seen>& seen);
  Fit fit_against_flow(const std::vector<Seen>& seen);
  Pose2 placed_by(const Seen& reference, double turn) const;
  double log_prior(const Pose2& at) const;
  void note_turn(const Start& start);
  bool in_sight(const CeilingCell& cell, const Pose2& at, double margin_px) const;
  void hold(const std::vector<Seen>& seen, const Pose2& at, bool afresh);
  Rest state_at(const Pose2& pose) const;
  Eigen::MatrixXd by_rows(const std::vector<Seen>& seen, const Eigen::MatrixXd& H,
                          const Eigen::MatrixXd& M) const;
  const Eigen::VectorXd& point_of(const Seen& one, const Rest& rest) const;
  Linearised linearise(const std::vector<Seen>& seen, const Rest& rest) const;
  std::vector<Seen> gated(const std::vector<Seen>& seen, const Linearised& all) const;
  std::vector<Seen> passed_gate(const std::vector<Seen>& seen, const Pose2& start);
  void note_lone_patch(const std::vector<Seen>& passed);
  Eigen::MatrixXd gain(const Linearised& all) const;
  Rest fused_state(const Linearised& all) const;
  Rest converged(const std::vector<Seen>& seen, const Pose2& start) const;
  Rest settle(std::vector<Seen>& passed, const Pose2& start);
  void forget(const CeilingCell& cell);
  struct PatchRows;
  PatchRows rows_of(const CeilingCell& cell, const PatchOnCeiling& patch, bool directed,
                    const Eigen::VectorXd& at) const;
  void express_anew(const Eigen::VectorXd& moved);
  void anchor(const std::vector<Seen>& passed);
  void weigh_shifts(const Linearised& all, const std::vector<Seen>& seen, const Pose2& at);
  void judge_presence(const std::vector<Seen>& seen, const Pose2& at);
  void normalise_shifts();
  void spread();
  void shift_by_chance(const Linearised& all, const Pose2& at, int reach);
  std::vector<std::pair<CeilingCell, double>> told_shifts() const;
  void fuse(const Linearised& all, const std::vector<Seen>& seen);
  void doubt();
  void shift_by(CeilingCell shift);
  using MotionJacobian = Eigen::Matrix<double, 3, 6>;
  /// Where a motion leads, what it makes of the state's covariance, and its own.
  struct Motion {
    Pose2 to;
    MotionJacobian F;
    Eigen::Matrix3d Q;
  };
  FlowMotion seen_motion(const ImageShift& shift) const;
  Motion led_on(const FlowMotion& step, const Eigen::Matrix3d& seen) const;
  void move(const Motion& motion);
  void enliven(const Eigen::Matrix3d& Q);
  Eigen::Matrix3d unknown_motion(double from_s, double to_s) const;
  void refresh_belief();

  CeilingCamera camera_;
  CeilingGrid grid_;
  CeilingFilterParams params_;
  Eigen::VectorXd x_;  ///< x, y, θ, tilt, tilt, log height, then three a patch
  Eigen::MatrixXd P_;
  std::map<CeilingCell, Eigen::Index> patches_;         ///< where a cell's three states begin
  std::set<CeilingCell> anchored_;                      ///< those whose patches' places were learnt
  Eigen::Matrix3d motion_P_ = Eigen::Matrix3d::Zero();  ///< of the pose, by motion since an update
  Shifts shifts_;
  bool spread_ = false;           ///< over all cells of the hall, and not yet sure of one
  bool elsewhere_ = false;        ///< in a cell, perhaps, that no shift stands for
  std::set<CeilingCell> judged_;  ///< cells whose presence or absence was weighed
  bool cells_unsure_ = false;  ///< whether the patches before were perhaps the same in other cells
  /// Of the patch that alone ended a wide prediction, until another agrees.
  std::optional<CeilingCell> lone_;
  double turned_ = 0.0;  ///< chance that the robot faces the other way
  Eigen::Vector2d turned_about_ = Eigen::Vector2d::Zero();
  FlowTrust flow_trust_;
  double gated_ = 0.0;                          ///< frames in a row, weighed
  std::optional<Eigen::Vector2d> contradicts_;  ///< a patch that did so alone, as it was believed
  std::vector<PatchOnCeiling> before_;          ///< of the last update
  bool flow_misled_ = false;                    ///< patches moved otherwise, and none with it since
  /// Of the motion in a tick of the odometry lately, at most; world frame.
  Eigen::Matrix3d lively_Q_ = Eigen::Matrix3d::Zero();
  double unknown_s_ = 0.0;     ///< for how long nothing was known of the motion
  double flow_alone_s_ = 0.0;  ///< for how long only the flow told it, since patches last agreed
  Stamp stamp_;
  Stamp updated_;
  Belief belief_;
};

}  // namespace vigia::localization
