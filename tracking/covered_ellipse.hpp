#pragma once

#include "blob_finder.hpp"

#include <optional>

namespace vigia::tracking {

/// The ellipse of which a blob shows the most, where something covers one arc of it: ellipses are
/// fitted to the blob's outline less each arc of several lengths, and the one counts on which most
/// of the outline lies. Nothing when less than the larger half does, or the blob is too small to
/// tell.
std::optional<EllipseShape> covered_ellipse(const Blob& blob);

/// A blob that was found in the halved copy of @p window, in the pixels of the window's image.
Blob doubled(const Blob& blob, const imaging::Window& window);

}  // namespace vigia::tracking
