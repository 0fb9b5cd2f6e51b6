// Chapter 11's picture: terrain and signs, lit by sun and sky, through the air before them; the sky where neither is.
#pragma once

#include "chapters/11_aerial_perspective/aerial_perspective.hpp"

namespace welkin {

// Pass "compose": draws the terrain over the picture so far. A scene without terrain keeps that picture.
app::Effect lit_terrain();

}  // namespace welkin
