// Follows every disc through a video, a folder of pictures or a live camera.
// track_discs INPUT

#include <cstdio>
#include <exception>

#include <vigia/imaging/picture_source.hpp>
#include <vigia/tracking/picture_run.hpp>

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  vigia::tracking::PictureRunParams params;
  params.min_radius_px = 4.0;
  vigia::tracking::PictureRun discs(params);
  const auto pictures = vigia::imaging::open_pictures(argv[1]);
  while (const auto picture = pictures->next())
    for (const auto& [target, feature] : discs.next(*picture->frame))
      if (feature.status == vigia::tracking::FeatureStatus::found)
        std::printf("%s: disc %d at (%.2f, %.2f) px\n", picture->name.c_str(), target,
                    feature.ellipse.u, feature.ellipse.v);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
