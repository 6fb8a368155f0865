#include "papers.hpp"

namespace vigia::app {

const std::vector<Paper>& papers() {
  static const std::vector<Paper> all{
      {"armingol", "odometry against relocalisation with a pan-tilt-zoom camera",
       &reproduce_armingol},
      {"quixote", "pose from one view of the nine-point colour pattern", &reproduce_quixote},
      {"minho", "a field's lines in a mirror camera: grid match, MCL, MUREA, kidnapping",
       &reproduce_minho},
      {"bais", "one landmark from two points: running fix against range and bearing",
       &reproduce_bais},
      {"chonbuk", "patches on a ceiling without identity, edge-based optical flow, their fusion",
       &reproduce_chonbuk},
  };
  return all;
}

}  // namespace vigia::app
