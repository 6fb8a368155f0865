#include "vigia/report/foxglove.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace vigia::report::foxglove {
namespace {

using Value = nlohmann::json;

bool has_type(const Value& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "integer") return value.is_number_integer();
  if (type == "boolean") return value.is_boolean();
  return type == "number" && value.is_number();
}

std::string below(std::string place, const std::string& name) {
  place += '.';
  place += name;
  return place;
}

/// Where @p value breaks @p rule, a JSON schema of types, required fields, sizes and choices.
std::string fault(const Value& value, const Value& rule, const std::string& place = "message") {
  if (rule.contains("type") && !has_type(value, rule["type"])) return place + ": type";
  if (rule.contains("oneOf")) {
    bool known = false;
    for (const Value& choice : rule["oneOf"]) known = known || choice["const"] == value;
    if (!known) return place + ": choice";
  }
  if (value.is_array()) {
    if (value.size() < rule.value("minItems", 0U)) return place + ": too few";
    if (value.size() > rule.value("maxItems", 1'000'000U)) return place + ": too many";
    for (std::size_t i = 0; i < value.size(); ++i)
      if (auto inner = fault(value[i], rule["items"], place + "[]"); !inner.empty()) return inner;
  }
  if (!value.is_object()) return {};
  for (const auto& name : rule.value("required", std::vector<std::string>{}))
    if (!value.contains(name)) return below(place, name).append(": missing");
  for (const auto& [name, inner] : value.items()) {
    if (!rule["properties"].contains(name)) return below(place, name).append(": unknown");
    if (auto deeper = fault(inner, rule["properties"][name], below(place, name)); !deeper.empty())
      return deeper;
  }
  return {};
}

Value parsed(Message kind, const std::string& text) {
  Value message = Value::parse(text);
  EXPECT_EQ(fault(message, Value::parse(schema(kind).text)), "") << text.substr(0, 500);
  return message;
}

WorldMap room() {
  WorldMap world;
  world.plan = FloorPlan({{0, 0}, {6, 0}, {6, 4}, {0, 4}}, 2.8, {{{3, 0}, {3, 2}, 2.8}}, {});
  TagShape tag;
  world.landmarks = LandmarkMap(
      {{1, wall_mount({6, 2, 1.5}, M_PI), DiscShape{0.1}}, {2, wall_mount({0, 2, 1.5}, 0.0), tag}});
  return world;
}

const Value& entity(const Value& scene, const std::string& id) {
  for (const Value& each : scene["entities"])
    if (each["id"] == id) return each;
  throw std::out_of_range(id);
}

TEST(Foxglove, SchemasAreThePublishedOnes) {
  for (const auto& [kind, name] :
       {std::pair{Message::camera_calibration, "CameraCalibration"},
        std::pair{Message::compressed_image, "CompressedImage"},
        std::pair{Message::frame_transforms, "FrameTransforms"},
        std::pair{Message::image_annotations, "ImageAnnotations"}, std::pair{Message::log, "Log"},
        std::pair{Message::odometry, "Odometry"}, std::pair{Message::pose_in_frame, "PoseInFrame"},
        std::pair{Message::poses_in_frame, "PosesInFrame"},
        std::pair{Message::scene_update, "SceneUpdate"}}) {
    EXPECT_EQ(schema(kind).name, "foxglove." + std::string(name));
    std::ifstream file(std::string(VIGIA_SOURCE_DIR) + "/src/report/foxglove/" + name + ".json");
    EXPECT_EQ(Value::parse(schema(kind).text), Value::parse(file));
    EXPECT_EQ(Value::parse(schema(kind).text)["title"], schema(kind).name);
  }
}

TEST(Foxglove, APoseKeepsItsPlaceTurnAndTime) {
  const Eigen::Isometry3d wMr = to_isometry({1.5, -2.0, 0.6}, 0.25);
  const Stamp at{3'040'000'000};
  const Value pose = parsed(Message::pose_in_frame, pose_in_frame(at, wMr));
  EXPECT_EQ(pose["timestamp"], Value({{"sec", 3}, {"nsec", 40'000'000}}));
  EXPECT_EQ(pose["frame_id"], "world");
  EXPECT_NEAR(pose["pose"]["position"]["y"], -2.0, 1e-9);
  EXPECT_NEAR(pose["pose"]["orientation"]["z"], std::sin(0.3), 1e-9);
  const Value frames =
      parsed(Message::frame_transforms, frame_transforms(at, {{"world", "robot", wMr}}));
  EXPECT_NEAR(frames["transforms"][0]["translation"]["z"], 0.25, 1e-9);
  parsed(Message::poses_in_frame, poses_in_frame(at, {wMr, wMr}));
}

TEST(Foxglove, OdometryHasTheCovarianceRowByRow) {
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  covariance(0, 1) = covariance(1, 0) = 1e-7;
  covariance(5, 5) = 4e-6;
  const Value message =
      parsed(Message::odometry, odometry({}, "ekf", Eigen::Isometry3d::Identity(), covariance));
  EXPECT_EQ(message["body_frame_id"], "ekf");
  EXPECT_DOUBLE_EQ(message["pose_covariance"][1], 1e-7);
  EXPECT_DOUBLE_EQ(message["pose_covariance"][6], 1e-7);
  EXPECT_DOUBLE_EQ(message["pose_covariance"][35], 4e-6);
}

TEST(Foxglove, AnImageIsBase64AndALogSaysHowBad) {
  const Value image = parsed(Message::compressed_image, compressed_image({}, "camera_0", "abc"));
  EXPECT_EQ(image["data"], "YWJj");
  const Value entry = parsed(Message::log, log({}, LogLevel::warning, "lost", "sigma \xff"));
  EXPECT_EQ(entry["level"], 3);
  EXPECT_EQ(entry["message"], "sigma \xEF\xBF\xBD");  // no UTF-8
}

TEST(Foxglove, AnnotationsAreMeasuredFromTheCornerOfTheFirstPixel) {
  imaging::Overlay overlay;
  overlay.measured = Ellipse{100.0, 50.0, 8.0, 6.0, 0.3};
  overlay.predicted = Ellipse{std::numeric_limits<double>::quiet_NaN(), 50.0, 8.0, 6.0, 0.3};
  overlay.points = {{10.0, 20.0}, {std::numeric_limits<double>::infinity(), 0.0}};
  overlay.lines = {"one", "two"};
  const Value message = parsed(Message::image_annotations, image_annotations({}, overlay));
  ASSERT_EQ(message["points"].size(), 2U);
  EXPECT_EQ(message["points"][0]["points"].size(), 48U);
  ASSERT_EQ(message["points"][1]["points"].size(), 1U);
  EXPECT_DOUBLE_EQ(message["points"][1]["points"][0]["x"], 10.5);
  EXPECT_DOUBLE_EQ(message["points"][1]["points"][0]["y"], 20.5);
  EXPECT_EQ(message["texts"][1]["text"], "two");
}

TEST(Foxglove, ACalibrationProjectsAsTheCameraDoes) {
  Intrinsics lens;
  lens.kdu = 0.08;
  const auto text = camera_calibration({}, "camera_0", lens);
  ASSERT_TRUE(text);
  const Value message = parsed(Message::camera_calibration, *text);
  const auto d = message["D"].get<std::vector<double>>();
  const auto k = message["K"].get<std::vector<double>>();
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0.3, 0.2, 1.0), Eigen::Vector3d(-0.4, 0.3, 1.0)}) {
    const double r2 = p.head<2>().squaredNorm();
    const Eigen::Vector2d xy =
        p.head<2>() * (1.0 + r2 * (d[0] + r2 * (d[1] + r2 * d[4])));  // plumb_bob
    const Eigen::Vector2d uv(k[0] * xy.x() + k[2], k[4] * xy.y() + k[5]);
    EXPECT_LT((uv - *project(lens, p)).norm(), 0.02);
  }
  EXPECT_FALSE(camera_calibration({}, "camera_0", UnifiedOmni{}));
}

TEST(Foxglove, ASceneHasTheWorldsWallsLandmarksAndRoute) {
  const Path route({{1.0, 1.0}, {2.0, 3.0}});
  const Value scene = parsed(Message::scene_update, world_scene({}, room(), route));
  EXPECT_EQ(entity(scene, "building")["triangles"][0]["points"].size(), 5U * 6U);
  EXPECT_EQ(entity(scene, "landmarks")["cylinders"].size(), 1U);
  EXPECT_EQ(entity(scene, "landmarks")["texts"][1]["text"], "L2");
  EXPECT_EQ(entity(scene, "route")["lines"][0]["points"].size(), 2U);
  parsed(Message::scene_update, robot_scene({}, "robot", 0.3));
}

TEST(Foxglove, ASceneHasAFieldAndACeilingWhereTheWorldHas) {
  WorldMap world = room();
  world.field.emplace();
  world.field->lines = {FieldLine::segment({-1, 0}, {1, 0}, 0.1),
                        FieldLine::arc({0, 0}, 1.0, 0.0, 2.0 * M_PI, 0.1)};
  FieldGoal goal;
  goal.from = {6, -1};
  goal.to = {6, 1};
  world.field->goals = {goal};
  world.field->posts = {CornerPost{}};
  world.ceiling.emplace();
  const Value scene = parsed(Message::scene_update, world_scene({}, world, {}));
  EXPECT_EQ(entity(scene, "field")["lines"].size(), 2U);
  EXPECT_EQ(entity(scene, "field")["cylinders"].size(), 1U);
  const Value& patches = entity(scene, "ceiling")["lines"][0]["points"];
  ASSERT_GE(patches.size(), 2U * 15U);  // one a metre in each direction
  EXPECT_DOUBLE_EQ(patches[0]["z"], world.ceiling->height_m);
}

TEST(Foxglove, AnEllipseHoldsTheBeliefsCovarianceAt95Percent) {
  Belief belief;
  belief.pose = {2.0, 1.0, 0.0};
  belief.covariance.diagonal() << 0.04, 0.01, 1e-4;
  Belief ambiguous = belief;
  ambiguous.hypotheses = {{{1, 1, 0}, belief.covariance, 0.5}, {{2, 2, 0}, belief.covariance, 0.5}};
  const Value scene =
      parsed(Message::scene_update, beliefs_scene({}, {{"ekf", &belief}, {"mcl", &ambiguous}}, {}));
  double widest = 0.0;
  for (const Value& p : entity(scene, "ekf")["lines"][0]["points"])
    widest = std::max(widest, std::abs(p["x"].get<double>() - 2.0));
  EXPECT_NEAR(widest, 0.2 * std::sqrt(5.991), 1e-3);
  EXPECT_EQ(entity(scene, "mcl")["lines"].size(), 2U);
  EXPECT_EQ(entity(scene, "ekf")["metadata"][1]["value"], "0.2");
}

}  // namespace
}  // namespace vigia::report::foxglove
