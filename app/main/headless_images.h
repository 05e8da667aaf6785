#pragma once
// The command line's pixels, made over render/.
#include "app/image_source.h"

#include <memory>

namespace lodestone {

// Draws off screen with surfaceless EGL; the context lives for one request. Main thread.
std::unique_ptr<ImageSource> makeHeadlessImages();

} // namespace lodestone
