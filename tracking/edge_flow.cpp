#include "vigia/tracking/edge_flow.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace vigia::tracking {
namespace {

/// The edge array turned about the image's middle, in whole pixels.
std::vector<Eigen::Vector2i> turned(const EdgeImage& edges, double turn) {
  const double c = std::cos(turn);
  const double s = std::sin(turn);
  const double u0 = 0.5 * (edges.width - 1);
  const double v0 = 0.5 * (edges.height - 1);
  std::vector<Eigen::Vector2i> moved;
  moved.reserve(edges.array.size());
  for (const Eigen::Vector2i& p : edges.array) {
    const double u = p.x() - u0;
    const double v = p.y() - v0;
    moved.emplace_back(static_cast<int>(std::lround(c * u - s * v + u0)),
                       static_cast<int>(std::lround(s * u + c * v + v0)));
  }
  return moved;
}

struct ShiftCount {
  int matched = 0;
  int inside = 0;
};

ShiftCount count_matches(const std::vector<Eigen::Vector2i>& array, const EdgeImage& after, int du,
                         int dv) {
  ShiftCount count;
  for (const Eigen::Vector2i& p : array) {
    const int u = p.x() + du;
    const int v = p.y() + dv;
    if (u < 0 || v < 0 || u >= after.width || v >= after.height) continue;
    ++count.inside;
    count.matched +=
        after.edge[static_cast<std::size_t>(v) * static_cast<std::size_t>(after.width) +
                   static_cast<std::size_t>(u)];
  }
  return count;
}

}  // namespace

EdgeImage find_edges(const vpImage<unsigned char>& image, const EdgeFlowParams& params) {
  const cv::Mat grey(static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()), CV_8U,
                     image.bitmap);
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {}, params.blur_px);
  cv::Mat edge;
  cv::Canny(smooth, edge, params.low, params.high);
  EdgeImage edges;
  edges.width = edge.cols;
  edges.height = edge.rows;
  edges.edge.resize(static_cast<std::size_t>(edge.cols) * static_cast<std::size_t>(edge.rows));
  auto out = edges.edge.begin();
  for (int v = 0; v < edge.rows; ++v) {
    const unsigned char* row = edge.ptr(v);
    for (int u = 0; u < edge.cols; ++u, ++out) {
      if (row[u] == 0) continue;
      *out = 1;
      edges.array.emplace_back(u, v);
    }
  }
  return edges;
}

EdgeMatch match_edges(const EdgeImage& before, const EdgeImage& after, const EdgeFlowParams& params,
                      const EdgeMatch& expected) {
  EdgeMatch best = expected;
  const int turns = static_cast<int>(std::lround(params.max_turn / params.turn_step));
  const int u = static_cast<int>(std::lround(expected.shift_px.x()));
  const int v = static_cast<int>(std::lround(expected.shift_px.y()));
  int most = -1;
  for (int k = -turns; k <= turns; ++k) {
    const double turn = expected.turn + k * params.turn_step;
    const std::vector<Eigen::Vector2i> array = turned(before, turn);
    for (int dv = v - params.max_shift_px; dv <= v + params.max_shift_px; ++dv) {
      for (int du = u - params.max_shift_px; du <= u + params.max_shift_px; ++du) {
        const ShiftCount count = count_matches(array, after, du, dv);
        if (count.matched <= most) continue;
        most = count.matched;
        const double share =
            array.empty() ? 1.0
                          : static_cast<double>(count.inside) / static_cast<double>(array.size());
        best = {Eigen::Vector2d(du, dv), turn, count.matched, 1.0 - share};
      }
    }
  }
  return best;
}

}  // namespace vigia::tracking
