#pragma once

#include <opencv2/core/utils/logger.hpp>

namespace vigia::imaging {

/// OpenCV's own messages may hold an address with its password, and say less than ours.
inline void silence_opencv() {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

}  // namespace vigia::imaging
