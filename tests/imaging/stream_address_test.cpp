#include "vigia/imaging/stream_address.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"

namespace vigia::imaging {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string address_error(const std::string& text) {
  try {
    parse_address(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(StreamAddress, CamerasAddressesAreTakenAsTheyAre) {
  for (const std::string text :
       {"rtsp://camera.local/stream", "rtsp://user:p%40ss@10.0.0.7:554/axis-media/media.amp?fps=25",
        "http://127.0.0.1:8080/video.mjpeg", "https://[::1]:8443/a/b", "rtsps://cam"})
    EXPECT_EQ(parse_address(text).url, text);
}

TEST(StreamAddress, TheLabelHasNeitherPasswordNorQuery) {
  EXPECT_EQ(parse_address("rtsp://user:secret@host:554/live?token=secret").label,
            "rtsp://host:554/live");
}

TEST(StreamAddress, NoMessageHasThePasswordHoweverWrongTheAddressIs) {
  for (const std::string text :
       {"rtsp://user:sec ret@host/", "rtsp://user:sec/ret@host/x", "rtsp://user:sec@ret@/x",
        "ftp://user:sec@host/x", "rtsp://user:sec@host:99999/", "rtsp://host/?sec!",
        "rtsp://user:sec?x@host:0/"}) {
    EXPECT_NE(address_error(text), "no error") << text;
    EXPECT_THAT(address_error(text), Not(HasSubstr("sec"))) << text;
  }
}

TEST(StreamAddress, OtherProtocolsAreRefused) {
  for (const std::string text :
       {"ftp://host/x", "file:///etc/passwd", "concat://a", "udp://@:1234", "v4l2:///dev/video0"})
    EXPECT_THAT(address_error(text),
                HasSubstr("begins with rtsp://, rtsps://, http:// or https://"));
}

TEST(StreamAddress, TheTextOfAPipelineIsRefused) {
  for (const std::string text :
       {"rtsp://host/x ! filesink location=/tmp/x", "http://host/a!b", "http://ho st/",
        "http://host/\"x\"", "http://host/'x'", "http://host/x;y", "http://host/%zz",
        "http://host/\n", "rtsp://-host/", "http:///path", "rtsp://host:80x/", "rtsp://host:0/"})
    EXPECT_NE(address_error(text), "no error") << text;
}

}  // namespace
}  // namespace vigia::imaging
