#include "vigia/localization/ring_pose.hpp"

#include "localization/points_views.hpp"

#include <gtest/gtest.h>

namespace vigia::localization {
namespace {

const Landmark kRingPattern = test::pattern(1, 0.0, 0.0, 0.0, 0.0);
const PatternShape kShape = std::get<PatternShape>(kRingPattern.shape);

PointsObservation seen_from(const Eigen::Isometry3d& cMl, double sigma = 0.0,
                            std::uint64_t seed = 1) {
  RandomStream random(seed, "ring");
  return test::observe_points(kRingPattern, test::evi_d31(), cMl, sigma, random);
}

/// The dots as points: the closed forms take a dot's image for that of its centre.
PointsObservation points_from(const Eigen::Isometry3d& cMl) {
  PointsObservation seen = seen_from(cMl);
  for (const PatternDot& dot : pattern_dots(kShape)) {
    const Eigen::Vector3d p_l(dot.centre_l.x(), dot.centre_l.y(), 0.0);
    seen.points[static_cast<std::size_t>(dot.label)].uv = *project(test::evi_d31(), cMl * p_l);
  }
  return seen;
}

void expect_view(const ViewParameters& view, const ViewParameters& truth, double tolerance) {
  EXPECT_NEAR(view.phi, truth.phi, tolerance);
  EXPECT_NEAR(wrap_angle(view.theta - truth.theta), 0.0, tolerance);
  EXPECT_NEAR(wrap_angle(view.psi - truth.psi), 0.0, tolerance);
  EXPECT_NEAR(view.distance, truth.distance, tolerance);
}

TEST(ViewParameters, PoseAndViewAreInverse) {
  for (const double theta : {-170.0, -60.0, 0.0, 45.0, 120.0}) {
    for (const double psi : {-100.0, 0.0, 170.0}) {
      const ViewParameters view{from_deg(35.0), from_deg(theta), from_deg(psi), 3.0};
      EXPECT_NEAR(pose_of(view).linear().determinant(), 1.0, 1e-12);
      expect_view(view_of(pose_of(view)), view, 1e-12);
    }
  }
}

TEST(ViewParameters, ACameraBelowThePatternHasThetaZero) {
  // 1 m below and 2 m in front of a pattern on the wall x = 0 that looks along +x.
  Eigen::Isometry3d wMc = Eigen::Isometry3d::Identity();
  wMc.translation() = Eigen::Vector3d(2.0, 0.0, -1.0);
  const Eigen::Vector3d z = -wMc.translation().normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY();  // the viewer's right
  wMc.linear() << x, z.cross(x), z;
  const ViewParameters view = view_of(wMc.inverse() * kRingPattern.wMl);
  expect_view(view, {std::atan2(1.0, 2.0), 0.0, 0.0, std::sqrt(5.0)}, 1e-12);
}

TEST(ViewParameters, TheTwinOfATwinIsTheViewItself) {
  Eigen::Isometry3d cMl = pose_of({from_deg(35.0), 0.4, -0.3, 3.0});
  cMl.translation() += Eigen::Vector3d(0.3, -0.2, 0.0);
  EXPECT_TRUE(twin_of(twin_of(cMl)).isApprox(cMl, 1e-12));
  EXPECT_FALSE(twin_of(cMl).isApprox(cMl, 0.1));
}

TEST(RingPose, TheExactFormRecoversEveryViewWithoutNoise) {
  for (const Ring ring : {Ring::outer, Ring::inner}) {
    for (const double phi : {5.0, 30.0, 60.0, 75.0}) {
      for (const double theta : {-150.0, -40.0, 30.0, 90.0}) {
        const ViewParameters truth{from_deg(phi), from_deg(theta), from_deg(20.0), 2.0};
        const auto pose = ring_pose(kShape, points_from(pose_of(truth)), {ring, RingMethod::exact});
        ASSERT_TRUE(pose);
        expect_view(pose->view, truth, 1e-6);
        EXPECT_TRUE(pose->cMl.isApprox(pose_of(truth), 1e-6));
        EXPECT_EQ(pose->frontal, phi < 25.0);
      }
    }
  }
}

TEST(RingPose, TheHomographyMakesTheExactFormExactOffCentreToo) {
  Eigen::Isometry3d cMl = pose_of({from_deg(50.0), from_deg(20.0), from_deg(5.0), 2.5});
  cMl.translation() += Eigen::Vector3d(0.06, -0.05, 0.0);  // about 125 px off
  const PointsObservation seen = points_from(cMl);
  const auto centred = ring_pose(kShape, seen, {Ring::outer, RingMethod::exact, true});
  const auto assumed = ring_pose(kShape, seen, {Ring::outer, RingMethod::as_published, false});
  ASSERT_TRUE(centred && assumed);
  EXPECT_TRUE(centred->cMl.isApprox(cMl, 1e-6));
  EXPECT_GT((assumed->cMl.inverse().translation() - cMl.inverse().translation()).norm(), 0.01);
}

TEST(RingPose, ThePublishedFormErrsByItsApproximation) {
  // Eq. 11 gives D cos-independently: a = fR/√(D² − R²s²) makes it short by R²s²/(2D) (errata).
  const double D = 1.25;
  const double phi = from_deg(60.0);
  const auto pose = ring_pose(kShape, points_from(pose_of({phi, 0.3, 0.0, D})),
                              {Ring::outer, RingMethod::as_published});
  ASSERT_TRUE(pose);
  const double s = kShape.outer_radius_m * std::sin(phi);
  EXPECT_NEAR(pose->view.distance, std::sqrt(D * D - s * s), 1e-6);
  EXPECT_NEAR(std::cos(pose->view.phi), std::cos(phi) * D / std::sqrt(D * D - s * s), 1e-6);
}

TEST(RingPose, ThePublishedFormTakesTheCameraToBeBelowThePattern) {
  const ViewParameters below{from_deg(40.0), from_deg(50.0), 0.0, 3.0};
  const ViewParameters above = twin_of(below);
  for (const ViewParameters& truth : {below, above}) {
    const auto pose =
        ring_pose(kShape, points_from(pose_of(truth)), {Ring::outer, RingMethod::as_published});
    EXPECT_NEAR(pose->view.theta, from_deg(50.0), 0.01);
  }
}

TEST(RingPose, TheTwinIsAsGoodFarAwayAndNotNearBy) {
  const auto ambiguous = [](double distance) {
    const PointsObservation seen = seen_from(pose_of({from_deg(40.0), 0.5, 0.0, distance}), 1.0);
    return ring_pose(kShape, seen, {})->twin_as_good;
  };
  EXPECT_FALSE(ambiguous(1.5));
  EXPECT_TRUE(ambiguous(8.0));
}

TEST(RingPose, AnIncompleteRingHasNoClosedForm) {
  PointsObservation seen = seen_from(pose_of({from_deg(40.0), 0.5, 0.0, 2.0}));
  seen.points.erase(seen.points.begin() + 3);
  EXPECT_FALSE(ring_pose(kShape, seen, {Ring::outer}));
  EXPECT_TRUE(ring_pose(kShape, seen, {Ring::inner}));
  seen.points.erase(seen.points.begin());  // the centre-point
  EXPECT_FALSE(ring_pose(kShape, seen, {Ring::inner}));
  EXPECT_TRUE(ring_pose(kShape, seen, {Ring::inner, RingMethod::as_published, false}));
}

TEST(RingPose, DotsOnALineLieOnNoEllipse) {
  std::array<Eigen::Vector2d, kDotsPerRing> line;
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = Eigen::Vector2d(0.1 * double(i), 0.2);
  EXPECT_FALSE(fit_ring(line));
  line.fill(Eigen::Vector2d(0.1, 0.1));
  EXPECT_FALSE(fit_ring(line));
}

TEST(RingPose, AnEllipseFarFromTheOriginIsFittedAsOneAtTheOrigin) {
  std::array<Eigen::Vector2d, kDotsPerRing> ring;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double turn = 2.0 * kPi * double(i) / kDotsPerRing + 0.2;
    const Eigen::Vector2d p(0.03 * std::cos(turn), 0.02 * std::sin(turn));
    ring[i] = Eigen::Rotation2Dd(0.4) * p + Eigen::Vector2d(0.5, -0.3);
  }
  const auto image = fit_ring(ring);
  ASSERT_TRUE(image);
  EXPECT_NEAR(image->a, 0.03, 1e-9);
  EXPECT_NEAR(image->b, 0.02, 1e-9);
  EXPECT_NEAR(image->psi, 0.4, 1e-9);
  const Eigen::Vector2d centre = Eigen::Rotation2Dd(0.4) * image->centre;
  EXPECT_LT((centre - Eigen::Vector2d(0.5, -0.3)).norm(), 1e-9);
}

}  // namespace
}  // namespace vigia::localization
