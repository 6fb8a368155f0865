#include "vigia/imaging/picture_source.hpp"

#include "bgr_frame.hpp"
#include "stdin_source.hpp"
#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "vigia/core/error.hpp"
#include "vigia/core/random.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::imaging {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vigia::testing::TempDir;

cv::Mat noise_picture(std::uint64_t seed, int width = 64, int height = 48) {
  RandomStream random(seed, "picture");
  cv::Mat bgr(height, width, CV_8UC3);
  for (int i = 0; i < 3 * width * height; ++i)
    bgr.data[i] = static_cast<unsigned char>(random.index(256));
  return bgr;
}

std::string encoded(const std::string& ending, const cv::Mat& bgr) {
  std::vector<unsigned char> bytes;
  cv::imencode(ending, bgr, bytes);
  return {bytes.begin(), bytes.end()};
}

template <typename Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(BgrFrame, IsThePictureThatViSPMakesOfItToTheByte) {
  const cv::Mat bgr = noise_picture(1);
  const BgrFrame frame(bgr);
  const ImageFrame same = decode_picture(encoded(".png", bgr), "noise");
  EXPECT_TRUE(grey_image(frame) == grey_image(same));
  EXPECT_TRUE(colour_image(frame) == colour_image(same));
  const Window window{7, 5, 20, 11};
  vpImage<unsigned char> crop(11, 20);
  frame.read_grey(window, crop.bitmap, 20);
  EXPECT_EQ(crop[3][4], grey_image(frame)[8][11]);
}

TEST(NumberedFiles, ComeInTheOrderOfTheirNumbersWithGaps) {
  const TempDir dir;
  for (const char* name :
       {"f0010.png", "f0002.png", "f12345.png", "f01.png", "f0003.pgm", "g0001.png", "f00a1.png"})
    std::ofstream(dir.path() / name) << "x";
  const auto files = numbered_files((dir.path() / "f%04d.png").string());
  std::vector<std::string> names;
  for (const auto& file : files) names.push_back(file.filename().string());
  EXPECT_THAT(names, ElementsAre("f0002.png", "f0010.png", "f12345.png"));
}

TEST(NumberedFiles, AnythingButOneNumberIsRefused) {
  for (const std::string pattern : {"a%s.png", "a%n.png", "a%4d.png", "a%04d%04d.png", "a%.png",
                                    "a%0.png", "a%000d.png", "a%d%%.png", "a%04x.png"})
    EXPECT_THAT(error_of([&] { numbered_files(pattern); }), HasSubstr("%d or %0Nd")) << pattern;
  EXPECT_THAT(error_of([] { numbered_files("/nowhere/a%d.png"); }), HasSubstr("no file"));
}

class Descriptor : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(::pipe(ends_), 0); }
  void TearDown() override {
    ::close(ends_[0]);
    if (writer_.joinable()) writer_.join();
  }
  /// Sends bytes in small pieces.
  void send(std::string bytes) {
    writer_ = std::thread([this, bytes = std::move(bytes)] {
      for (std::size_t at = 0; at < bytes.size(); at += 1000) {
        const std::size_t count = std::min<std::size_t>(1000, bytes.size() - at);
        if (::write(ends_[1], bytes.data() + at, count) < 0) break;
      }
      ::close(ends_[1]);
    });
  }
  int ends_[2] = {-1, -1};
  std::thread writer_;
};

TEST_F(Descriptor, PicturesOfAllFormatsComeOneAfterTheOther) {
  const cv::Mat a = noise_picture(2);
  const cv::Mat b = noise_picture(3, 33, 21);
  send(encoded(".jpg", a) + encoded(".png", b) + encoded(".ppm", a) + encoded(".jpg", b));
  const auto source = open_descriptor(ends_[0], {});
  std::vector<int> widths;
  while (const auto picture = source->next()) widths.push_back(picture->frame->width());
  EXPECT_THAT(widths, ElementsAre(64, 33, 64, 33));
}

TEST_F(Descriptor, WhatCameBeforeATruncatedPictureIsThere) {
  const std::string whole = encoded(".png", noise_picture(4));
  send(whole + whole.substr(0, whole.size() / 2));
  const auto source = open_descriptor(ends_[0], {});
  EXPECT_TRUE(source->next());
  EXPECT_THAT(error_of([&] { source->next(); }),
              HasSubstr("stdin, picture 2: this picture ends early"));
}

TEST_F(Descriptor, WhatIsNoPictureIsSaidToBeNone) {
  send("name,age\nAda,36\n");
  const auto source = open_descriptor(ends_[0], {});
  EXPECT_THAT(error_of([&] { source->next(); }), HasSubstr("no JPEG, PNG or binary PNM"));
}

TEST_F(Descriptor, NothingAtAllIsAnError) {
  send("");
  const auto source = open_descriptor(ends_[0], {});
  EXPECT_THAT(error_of([&] { source->next(); }), HasSubstr("no picture came"));
}

TEST(Pictures, AVideoHasNumbersAndTimes) {
  const TempDir dir;
  const std::string file = (dir.path() / "noise.avi").string();
  {
    cv::VideoWriter writer(file, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10.0, {64, 48});
    if (!writer.isOpened()) GTEST_SKIP() << "OpenCV has no encoder for MJPEG";
    for (std::uint64_t k = 0; k < 4; ++k) writer.write(noise_picture(k));
  }
  const auto source = open_pictures(file);
  std::vector<double> times;
  std::vector<std::string> names;
  while (const auto picture = source->next()) {
    times.push_back(*picture->time_s);
    names.push_back(picture->name);
  }
  EXPECT_THAT(names, ElementsAre("noise#00001", "noise#00002", "noise#00003", "noise#00004"));
  ASSERT_EQ(times.size(), 4U);
  EXPECT_NEAR(times[3] - times[1], 0.2, 1e-6);
}

TEST(Pictures, AVideoWithoutTimeStampsHasTheTimesOfItsRate) {
  const std::string file = "/usr/share/visp-images-data/ViSP-images/video/cube.mpeg";
  if (!fs::exists(file)) GTEST_SKIP() << "visp-images-data is not installed";
  const auto source = open_pictures(file);
  // The last picture of this stream has no stamp.
  int number = 0;
  while (const auto picture = source->next()) {
    ASSERT_TRUE(picture->time_s);
    EXPECT_NEAR(*picture->time_s, 0.04 * number++, 0.05);
  }
  EXPECT_EQ(number, 79);
}

TEST(Pictures, WhatIsNoVideoIsSaidToBeNone) {
  const TempDir dir;
  const fs::path file = dir.path() / "text.mp4";
  std::ofstream(file) << "no video";
  EXPECT_THAT(error_of([&] { open_pictures(file.string()); }), HasSubstr("no video"));
  EXPECT_THAT(error_of([] { open_pictures("/dev/video987"); }), HasSubstr("no camera"));
}

/// A camera on loopback: pictures as multipart/x-mixed-replace, to one client after the other.
class LoopbackCamera {
 public:
  LoopbackCamera(std::vector<int> pictures_per_client, std::string picture)
      : picture_(std::move(picture)) {
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address);
    ::listen(socket_, 4);
    socklen_t length = sizeof address;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length);
    port_ = ntohs(address.sin_port);
    server_ = std::thread([this, counts = std::move(pictures_per_client)] {
      for (const int count : counts) serve(count);
    });
  }
  ~LoopbackCamera() {
    ::shutdown(socket_, SHUT_RDWR);
    ::close(socket_);
    server_.join();
  }
  std::string address() const {
    return "http://watchman:swordfish@127.0.0.1:" + std::to_string(port_) + "/video.mjpeg";
  }

 private:
  void serve(int count) const {
    const int client = ::accept(socket_, nullptr, nullptr);
    if (client < 0) return;
    char request[4096];
    if (::recv(client, request, sizeof request, 0) > 0) {
      send(client,
           "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace;"
           "boundary=frame\r\n\r\n");
      for (int k = 0; k < count; ++k)
        send(client, "--frame\r\nContent-Type: image/jpeg\r\nContent-Length: " +
                         std::to_string(picture_.size()) + "\r\n\r\n" + picture_ + "\r\n");
    }
    ::close(client);
  }
  static void send(int client, const std::string& bytes) {
    ::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  int socket_ = -1;
  int port_ = 0;
  std::string picture_;
  std::thread server_;
};

TEST(Pictures, ACameraOnLoopbackIsReachedAgainWhenItHangsUp) {
  const LoopbackCamera camera({6, 6}, encoded(".jpg", noise_picture(5, 320, 240)));
  SourceParams params;
  params.timeout_s = 3.0;
  params.reconnect_s = 0.05;
  params.reconnections = 1;
  std::unique_ptr<PictureSource> source;
  try {
    source = open_pictures(camera.address(), params);
  } catch (const InputError& error) {
    GTEST_SKIP() << "no back end of OpenCV opens MJPEG over http: " << error.what();
  }
  int pictures = 0;
  const std::string error = error_of([&] {
    while (const auto picture = source->next()) {
      ++pictures;
      EXPECT_EQ(picture->frame->width(), 320);
      EXPECT_TRUE(picture->time_s);
    }
  });
  // A demultiplexer may keep the last picture of a connection to itself.
  EXPECT_GE(pictures, 8);
  EXPECT_THAT(error, HasSubstr("gives no more pictures"));
  EXPECT_THAT(error, ::testing::Not(HasSubstr("swordfish")));
}

TEST(Pictures, ACameraThatIsNotThereIsAnErrorWithoutItsPassword) {
  ::testing::internal::CaptureStderr();
  const std::string error = error_of([] {
    SourceParams params;
    params.timeout_s = 1.0;
    open_pictures("rtsp://watchman:swordfish@127.0.0.1:1/live", params);
  });
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(error, HasSubstr("rtsp://127.0.0.1:1/live: no camera that can be opened"));
  EXPECT_THAT(error + log, ::testing::Not(HasSubstr("swordfish")));
}

}  // namespace
}  // namespace vigia::imaging
