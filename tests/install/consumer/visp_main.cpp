// Drives the simulated robot as a vpRobot and writes and reads a picture, with the module that is
// loaded for it.

#include <cstdio>

#include <vigia/imaging/image_frame.hpp>
#include <vigia/sim/visp_robot.hpp>

int main(int, char** argv) {
  using namespace vigia;
  sim::VispRobot robot(sim::RobotParams{}, Pose2{}, 8.0, 1);
  vpRobot& visp = robot;
  visp.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  visp.setVelocity(vpRobot::ARTICULAR_FRAME, vpColVector(std::vector<double>{0.2, 0.0, 0.0, 0.0}));
  robot.advance(Duration::from_seconds(1.0));
  vpColVector position;
  visp.getPosition(vpRobot::ARTICULAR_FRAME, position);

  const std::string file = std::string(argv[0]) + ".png";
  imaging::write_png(file, vpImage<vpRGBa>(24, 32, vpRGBa(10, 20, 30)));
  const imaging::ImageFrame picture = imaging::read_image(file);
  std::printf("drove %.3f m, a picture of %dx%d\n", position[0], picture.width(), picture.height());
  return position[0] > 0.0 && picture.width() == 32 && picture.height() == 24 ? 0 : 1;
}
