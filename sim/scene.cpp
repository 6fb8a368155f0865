#include "vigia/sim/scene.hpp"

#include "blurred_frame.hpp"
#include "body_view.hpp"
#include "decal.hpp"
#include "lamp.hpp"
#include "landmark_decals.hpp"
#include "light_rows.hpp"
#include "pixel_noise.hpp"
#include "rays.hpp"
#include "simd.hpp"
#include "surface.hpp"
#include "texture.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "vigia/core/random.hpp"
#include "vigia/sim/appearance.hpp"

namespace vigia::sim {
namespace {

using imaging::Window;

constexpr int kTile = 16;
constexpr ViewId kPerson = 0xfffe;  ///< the winner of a pixel that shows somebody
constexpr int kGrey = -1;           ///< instead of a colour channel
constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

/// The first surface of @p surfaces among the faces that carries a picture of this frame.
std::size_t face_under(const std::vector<Surface>& surfaces, const Eigen::Isometry3d& wMd,
                       double tolerance_m) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Surface& surface = surfaces[i];
    const Eigen::Vector3d normal = surface.axis_s.cross(surface.axis_t);
    if (std::abs(normal.dot(wMd.linear().col(2))) < 0.99) continue;
    const Eigen::Vector3d offset = wMd.translation() - surface.origin_w;
    if (std::abs(normal.dot(offset)) > tolerance_m) continue;
    if (surface.corners_w.empty()) return i;
    const double s = surface.axis_s.dot(offset);
    const double t = surface.axis_t.dot(offset);
    double s_end = 0.0;
    double t_end = 0.0;
    for (const Eigen::Vector3d& corner : surface.corners_w) {
      s_end = std::max(s_end, surface.axis_s.dot(corner - surface.origin_w));
      t_end = std::max(t_end, surface.axis_t.dot(corner - surface.origin_w));
    }
    if (s >= 0.0 && s <= s_end && t >= 0.0 && t <= t_end) return i;
  }
  return kNowhere;
}

DecalShape shape_of(ClutterKind kind) {
  switch (kind) {
    case ClutterKind::ellipse:
      return DecalShape::ellipse;
    case ClutterKind::ring:
      return DecalShape::ring;
    case ClutterKind::square:
      return DecalShape::square;
    case ClutterKind::half_disc:
      return DecalShape::half_disc;
    case ClutterKind::disc:
      return DecalShape::disc;
    case ClutterKind::blob:
      break;
  }
  return DecalShape::blob;
}

Eigen::Isometry3d frame_of(const Clutter& clutter) {
  Eigen::Isometry3d wMd = clutter.on_floor
                              ? Eigen::Isometry3d(Eigen::Translation3d(clutter.centre_w))
                              : wall_mount(clutter.centre_w, clutter.normal_yaw);
  return wMd * Eigen::AngleAxisd(clutter.turn, Eigen::Vector3d::UnitZ());
}

VIGIA_PIXEL_LOOP
void evaluate(const Linear& f, const float* __restrict x, const float* __restrict y, int count,
              float* __restrict out) {
  const Linear k = f;
  for (int i = 0; i < count; ++i) out[i] = k.a * x[i] + k.b * y[i] + k.c;
}

VIGIA_PIXEL_LOOP
void mix(const float* __restrict share, float grey, int count, float* __restrict row) {
  for (int i = 0; i < count; ++i) row[i] += share[i] * (grey - row[i]);
}

VIGIA_PIXEL_LOOP
void keep_where(const ViewId* __restrict winner, ViewId id, int count, float* __restrict share) {
  for (int i = 0; i < count; ++i) share[i] = winner[i] == id ? share[i] : 0.0F;
}

VIGIA_PIXEL_LOOP
void take_where(const ViewId* __restrict winner, ViewId id, const float* __restrict grey, int count,
                float* __restrict row) {
  for (int i = 0; i < count; ++i) row[i] = winner[i] == id ? grey[i] : row[i];
}

}  // namespace

struct Scene::Impl {
  Impl(const WorldMap& world, const Appearance& look, std::uint64_t noise_seed)
      : seed(noise_seed),
        light(static_cast<float>(look.light)),
        tile(derive_seed(look.seed, "noise tile")),
        surfaces(building_surfaces(world.plan, look)) {
    for (const Clutter& clutter : look.clutter) {
      Decal mark{shape_of(clutter.kind),
                 frame_of(clutter),
                 clutter.size_m,
                 static_cast<float>(clutter.grey),
                 clutter.kind == ClutterKind::disc,
                 0};
      mark.surface = face_under(surfaces, mark.wMd, 0.02);
      if (mark.surface != kNowhere) decals.push_back(mark);
    }
    for (const Landmark& landmark : world.landmarks.all()) hang(landmark, look);
    if (look.light_kelvin != Appearance{}.light_kelvin) shine(lamp_gains(look.light_kelvin));
  }

  /// Gives everything the lamp's colour.
  void shine(const std::array<float, 3>& gains) {
    for (Surface& surface : surfaces) surface.material = lit(surface.material, gains);
    for (Decal& decal : decals) {
      const Ink shone = lit(Ink{decal.grey, decal.tint}, gains);
      decal.grey = shone.grey;
      decal.tint = shone.tint;
    }
  }

  /// A landmark's sheet and picture, on the face under it or on a board of its own.
  void hang(const Landmark& landmark, const Appearance& look) {
    const double half_width = sheet_half_width(landmark, look);
    std::size_t under = face_under(surfaces, landmark.wMl, 0.02);
    if (under == kNowhere) {
      under = surfaces.size();
      surfaces.push_back(board_surface(
          landmark.wMl, 1.1 * half_width,
          obstacle_material(look.obstacle_grey, look.contrast, derive_seed(look.seed, under))));
    }
    for (Decal& decal : landmark_decals(landmark, look)) {
      decal.surface = under;
      decals.push_back(std::move(decal));
    }
  }

  std::uint64_t seed;
  float light;
  NoiseTile tile;
  std::vector<Surface> surfaces;
  std::vector<Decal> decals;  ///< in the order in which they are painted
};

namespace {

/// Neighbouring tiles of one row of tiles that see the same surfaces.
struct Run {
  int u0;
  int u1;
  bool pure;
  std::vector<ViewId> views;
};

}  // namespace

/// One instant of an exposure. The arithmetic of a pixel depends on its (u, v), on the tile of the
/// frame's grid that it lies in, and on the exposure; never on the window.
class SceneFrame : public imaging::Frame, public Radiance {
 public:
  SceneFrame(const Scene::Impl& scene, const Exposure::Instant& instant,
             const std::optional<LightNow>& light, const Intrinsics& intrinsics, Stamp stamp,
             const ImagingParams& params)
      : scene_(scene),
        wMc_(instant.wMc),
        people_(instant.people),
        light_now_(light),
        intrinsics_(intrinsics),
        params_(params),
        noise_(scene.seed, stamp) {}

  int width() const override { return intrinsics_.width; }
  int height() const override { return intrinsics_.height; }

  void read_grey(const Window& window, unsigned char* out, std::ptrdiff_t stride) const override {
    render(window, [&](int v, Row& row) {
      paint_decals(window.u, v, window.width, row, kGrey, row.grey.data());
      shine(row, row.grey.data(), window.width);
      noise_.add_and_round(row.grey.data(), static_cast<float>(params_.noise_sigma), window.u, v, 0,
                           window.width, out + (v - window.v) * stride);
    });
  }

  void add_grey(const Window& window, std::vector<float>& sum) const override {
    render(window, [&](int v, Row& row) {
      paint_decals(window.u, v, window.width, row, kGrey, row.grey.data());
      shine(row, row.grey.data(), window.width);
      add(row.grey.data(), window.width, row_of(sum, window, v));
    });
  }

  void add_channel(const Window& window, int channel, std::vector<float>& sum) const override {
    std::vector<float> levels(static_cast<std::size_t>(window.width));
    render(window, [&](int v, Row& row) {
      tint(row, channel, levels);
      paint_decals(window.u, v, window.width, row, params_.colour ? channel : kGrey, levels.data());
      shine(row, levels.data(), window.width);
      add(levels.data(), window.width, row_of(sum, window, v));
    });
  }

  void read_colour(const Window& window, vpRGBa* out, std::ptrdiff_t stride) const override {
    const auto count = static_cast<std::size_t>(window.width);
    std::vector<float> channel(count);
    std::vector<unsigned char> bytes(count);
    render(window, [&](int v, Row& row) {
      vpRGBa* pixels = out + (v - window.v) * stride;
      for (int c = 0; c < 3; ++c) {
        tint(row, c, channel);
        paint_decals(window.u, v, window.width, row, params_.colour ? c : kGrey, channel.data());
        shine(row, channel.data(), window.width);
        noise_.add_and_round(channel.data(), static_cast<float>(params_.noise_sigma), window.u, v,
                             params_.colour ? c : 0, window.width, bytes.data());
        for (std::size_t i = 0; i < count; ++i) {
          (c == 0 ? pixels[i].R : c == 1 ? pixels[i].G : pixels[i].B) = bytes[i];
          pixels[i].A = vpRGBa::alpha_default;
        }
      }
    });
  }

 private:
  struct Row {
    explicit Row(int count)
        : x(static_cast<std::size_t>(count)),
          y(x),
          grey(x),
          other(x),
          depth(x),
          winner(x.size()),
          hit(x.size()) {}
    std::vector<float> x, y, grey, other, depth;
    std::vector<ViewId> winner;
    std::vector<unsigned char> hit;
  };

  static void add(const float* levels, int count, float* sum) {
    for (int i = 0; i < count; ++i) sum[i] += levels[i];
  }
  static float* row_of(std::vector<float>& sum, const Window& window, int v) {
    return sum.data() + static_cast<std::ptrdiff_t>(v - window.v) * window.width;
  }

  /// Finds what the exposure sees. Done when the first pixel is asked for.
  void prepare() const {
    prepared_ = true;
    const Eigen::Isometry3d cMw = wMc_.inverse(Eigen::Isometry);
    const RayBox whole = ray_box(intrinsics_, 0, intrinsics_.width - 1, 0, intrinsics_.height - 1);
    std::vector<SurfaceView> all;
    std::vector<ViewId> every;
    for (std::size_t i = 0; i < scene_.surfaces.size(); ++i) {
      SurfaceView view;
      if (!make_view(scene_.surfaces[i], cMw, intrinsics_.px, view)) continue;
      view.index = i;
      every.push_back(static_cast<ViewId>(all.size()));
      all.push_back(view);
    }
    std::vector<ViewId> seen;
    bool pure = false;
    visible_in(all, every, whole, seen, pure);
    view_of_surface_.assign(scene_.surfaces.size(), -1);
    for (const ViewId id : seen) {
      view_of_surface_[all[id].index] = static_cast<int>(views_.size());
      views_.push_back(all[id]);
    }
    for (const Decal& decal : scene_.decals) {
      if (view_of_surface_[decal.surface] < 0) continue;
      DecalView view(decal, cMw, intrinsics_, params_.blur_px);
      if (!view.box().empty()) decals_.push_back(std::move(view));
    }
    if (light_now_) light_.emplace(*light_now_, cMw);
    for (const Person& person : people_) {
      for (const BodyPart& part : body_parts(person)) {
        const BodyPartView view(part, wMc_, intrinsics_);
        if (!view.box().empty()) limbs_.push_back(view);
      }
    }
  }

  template <typename Finish>
  void render(const Window& window, Finish finish_row) const {
    if (window.empty()) return;
    if (!prepared_) prepare();
    Row row(window.width);
    for (int v = window.v; v < window.bottom();) {
      const int tile_v = v / kTile * kTile;
      const std::vector<Run> runs = runs_of(window, tile_v);
      for (; v < std::min(window.bottom(), tile_v + kTile); ++v) {
        paint_surfaces(window.u, v, window.width, runs, row);
        paint_people(window.u, v, window.width, row);
        finish_row(v, row);
      }
    }
  }

  std::vector<Run> runs_of(const Window& window, int tile_v) const {
    std::vector<ViewId> every(views_.size());
    for (std::size_t i = 0; i < every.size(); ++i) every[i] = static_cast<ViewId>(i);
    std::vector<ViewId> near_row;
    bool pure = false;
    const int last_v = tile_v + kTile - 1;
    visible_in(
        views_, every,
        ray_box(intrinsics_, window.u / kTile * kTile, window.right() + kTile, tile_v, last_v),
        near_row, pure);
    std::vector<Run> runs;
    std::vector<ViewId> visible;
    for (int u = window.u / kTile * kTile; u < window.right(); u += kTile) {
      visible_in(views_, near_row, ray_box(intrinsics_, u, u + kTile - 1, tile_v, last_v), visible,
                 pure);
      const int u0 = std::max(u, window.u);
      const int u1 = std::min(u + kTile, window.right());
      if (!runs.empty() && runs.back().pure == pure && runs.back().views == visible)
        runs.back().u1 = u1;
      else
        runs.push_back({u0, u1, pure, visible});
    }
    return runs;
  }

  void paint_surfaces(int u, int v, int count, const std::vector<Run>& runs, Row& row) const {
    row_rays(intrinsics_, u, v, count, row.x.data(), row.y.data());
    for (const Run& run : runs) {
      const int first = run.u0 - u;
      const int length = run.u1 - run.u0;
      if (run.pure) {
        std::fill_n(row.winner.data() + first, length, run.views.front());
        shade(views_[run.views.front()], scene_.tile.data(), row.x.data() + first,
              row.y.data() + first, length, row.grey.data() + first);
        if (light_ || !limbs_.empty())
          evaluate(views_[run.views.front()].inverse_depth, row.x.data() + first,
                   row.y.data() + first, length, row.depth.data() + first);
      } else {
        paint_mixed(run, first, length, row);
      }
    }
  }

  void paint_mixed(const Run& run, int first, int length, Row& row) const {
    constexpr ViewId kNone = 0xffff;
    ViewId* winner = row.winner.data() + first;
    std::fill_n(winner, length, kNone);
    std::fill_n(row.depth.data() + first, length, 0.0F);
    std::fill_n(row.grey.data() + first, length, 0.0F);
    for (const ViewId id : run.views)
      take_nearest(views_[id], id, row.x.data() + first, row.y.data() + first, length,
                   row.depth.data() + first, winner);
    for (const ViewId id : run.views) {
      ViewId* begin = std::find(winner, winner + length, id);
      if (begin == winner + length) continue;
      ViewId* end = winner + length;
      while (*(end - 1) != id) --end;
      const auto from = begin - winner + first;
      const int n = static_cast<int>(end - begin);
      shade(views_[id], scene_.tile.data(), row.x.data() + from, row.y.data() + from, n,
            row.other.data() + from);
      take_where(begin, id, row.other.data() + from, n, row.grey.data() + from);
    }
  }

  /// Limbs that stand before what is painted already, and hide what hangs on it.
  void paint_people(int u, int v, int count, Row& row) const {
    for (const BodyPartView& limb : limbs_) {
      const Window& box = limb.box();
      const int from = std::max(u, box.u);
      const int n = std::min(u + count, box.right()) - from;
      if (v < box.v || v >= box.bottom() || n <= 0) continue;
      const auto at = static_cast<std::size_t>(from - u);
      std::fill_n(row.hit.data() + at, n, static_cast<unsigned char>(0));
      limb.paint(row.x.data() + at, row.y.data() + at, n, row.depth.data() + at,
                 row.grey.data() + at, row.hit.data() + at);
      for (std::size_t i = at; i < at + static_cast<std::size_t>(n); ++i)
        if (row.hit[i] != 0) row.winner[i] = kPerson;
    }
  }

  void paint_decals(int u, int v, int count, Row& row, int channel, float* grey) const {
    for (DecalView& decal : decals_) {
      const Window& box = decal.box();
      if (v < box.v || v >= box.bottom()) continue;
      const int from = std::max(u, box.u);
      const int n = std::min(u + count, box.right()) - from;
      if (n <= 0) continue;
      const int at = from - u;
      const auto id = static_cast<ViewId>(view_of_surface_[decal.decal().surface]);
      decal.coverage(from, v, n, row.x.data() + at, row.y.data() + at, row.other.data() + at);
      keep_where(row.winner.data() + at, id, n, row.other.data() + at);
      const float tint =
          channel == kGrey ? 1.0F : decal.decal().tint[static_cast<std::size_t>(channel)];
      mix(row.other.data() + at, decal.decal().grey * tint, n, grey + at);
    }
  }

  void tint(const Row& row, int channel, std::vector<float>& out) const {
    for (std::size_t i = 0; i < out.size(); ++i) {
      const bool tinted = params_.colour && row.winner[i] < views_.size();
      out[i] =
          row.grey[i] *
          (tinted ? views_[row.winner[i]].material->tint[static_cast<std::size_t>(channel)] : 1.0F);
    }
  }

  void shine(const Row& row, float* grey, int count) const {
    if (scene_.light != 1.0F)
      for (int i = 0; i < count; ++i) grey[i] *= scene_.light;
    if (light_) light_->apply(row.x.data(), row.y.data(), row.depth.data(), count, grey);
  }

  const Scene::Impl& scene_;
  Eigen::Isometry3d wMc_;
  std::vector<Person> people_;
  std::optional<LightNow> light_now_;
  Intrinsics intrinsics_;
  ImagingParams params_;
  PixelNoise noise_;
  mutable bool prepared_ = false;
  mutable std::vector<SurfaceView> views_;
  mutable std::vector<int> view_of_surface_;
  mutable std::vector<DecalView> decals_;
  mutable std::vector<BodyPartView> limbs_;
  mutable std::optional<LightRows> light_;
};

Scene::Scene(const WorldMap& world, const std::shared_ptr<const Appearance>& appearance,
             std::uint64_t seed)
    : impl_(std::make_unique<Impl>(world, appearance ? *appearance : Appearance{},
                                   derive_seed(seed, "pixel noise"))) {}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

std::unique_ptr<imaging::Frame> Scene::expose(const Eigen::Isometry3d& wMc,
                                              const Intrinsics& intrinsics, Stamp stamp,
                                              const ImagingParams& params) const {
  return expose(Exposure{{{wMc, {}}}, std::nullopt}, intrinsics, stamp, params);
}

std::unique_ptr<imaging::Frame> Scene::expose(const Exposure& exposure,
                                              const Intrinsics& intrinsics, Stamp stamp,
                                              const ImagingParams& params) const {
  if (exposure.instants.size() == 1)
    return std::make_unique<SceneFrame>(*impl_, exposure.instants.front(), exposure.light,
                                        intrinsics, stamp, params);
  std::vector<std::unique_ptr<Radiance>> instants;
  for (const Exposure::Instant& instant : exposure.instants)
    instants.push_back(
        std::make_unique<SceneFrame>(*impl_, instant, exposure.light, intrinsics, stamp, params));
  return std::make_unique<BlurredFrame>(std::move(instants), intrinsics.width, intrinsics.height,
                                        PixelNoise(impl_->seed, stamp), params);
}

}  // namespace vigia::sim
