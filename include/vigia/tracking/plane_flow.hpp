#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/image_shift.hpp"

namespace vigia::tracking {

struct PlaneFlowParams {
  int block_px = 8;        ///< of each block the pixel of the greatest slope, if it has any, counts
  double min_slope = 4.0;  ///< grey levels a pixel, after smoothing
  int min_points = 40;
  double min_overlap = 0.6;    ///< share of a key frame's points still in sight; below, a new one
  double min_agreement = 0.5;  ///< share of the points that fit
  double min_correlation = 0.85;  ///< of the two pictures' grey values at the points
  double max_search_px = 24.0;    ///< half the window of shifts where the prediction fails
};

/// What became of a frame.
enum class FlowStatus {
  key,      ///< the first: nothing to compare it with
  matched,  ///< to the key frame
  failed,   ///< no texture, or no agreement; the frame is the next key frame
};

struct PlaneFlowResult {
  FlowStatus status = FlowStatus::key;
  ImageShift since_key;    ///< from the key frame to this one
  bool new_key = false;    ///< this frame is the key frame of the next
  double agreement = 0.0;  ///< share of the points in sight that fit
};

/// Ego-motion under a flat ceiling from the grey values at edge pixels. A frame is compared with a
/// key frame, not with the one before, so that errors grow by the key frame; Gauss–Newton on turn,
/// shift, gain and offset with a robust weight, from the motion so far carried on, or where that
/// fails from a search in a blurred picture, and last from the peak of the phase correlation.
/// Saturated pixels count for nothing.
class PlaneFlow {
 public:
  /// @p level turns directions of the camera into those of a camera that looks straight at the
  /// plane: the mounting, as far as it is known.
  PlaneFlow(const CameraModel& model, const Eigen::Matrix3d& level,
            const PlaneFlowParams& params = {});
  ~PlaneFlow();
  PlaneFlow(PlaneFlow&&) noexcept;

  PlaneFlowResult next(const vpImage<unsigned char>& image);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// A PlaneFlow whose matches with key frames are turned into motions from frame to frame.
class FrameFlow {
 public:
  FrameFlow(const CameraModel& model, const Eigen::Matrix3d& level,
            const PlaneFlowParams& params = {});

  /// The motion since the frame before, also over frames that nobody saw; nothing for the first
  /// and where the match failed.
  std::optional<ImageShift> next(const vpImage<unsigned char>& image);
  /// Of the last match: share of the points in sight that fit.
  double agreement() const { return agreement_; }

 private:
  PlaneFlow flow_;
  ImageShift since_key_;
  double agreement_ = 0.0;
};

}  // namespace vigia::tracking
