/// From a rendered frame to its files.
#pragma once

#include <string>
#include <vector>

#include "pipeline/frame/kept_pictures.h"
#include "pipeline/frame/render_frame.h"

namespace trapeze {

/// Writes the displays of the context's scene, as write_displays does, with what a picture says of its
/// making: the scene's files, the frame, the tile, the date, or that which the environment's
/// SOURCE_DATE_EPOCH says, so that one who sets it gets the same bytes each time. The time and the names of
/// the files go to the frame's statistics. Pictures of earlier frames are kept, if `kept` is not null. False
/// when a file was not written; that has been reported.
bool write_frame(FrameResult& frame, const RenderContext& context, const Access& access,
                 const std::vector<std::string>& scene_files, KeptPictures* kept = nullptr);

}  // namespace trapeze
