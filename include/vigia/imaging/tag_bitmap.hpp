#pragma once

#include <array>

namespace vigia::imaging {

inline constexpr int kTagFields =
    8;  ///< across a tag of the family 36h11, its black border included

/// The fields of a tag as a viewer sees them, row by row from the top: true is black.
using TagBitmap = std::array<std::array<bool, kTagFields>, kTagFields>;

/// The picture of AprilTag 36h11 number @p tag (0–586), from libapriltag's table. Throws
/// std::invalid_argument for another number.
TagBitmap tag_bitmap(int tag);

}  // namespace vigia::imaging
