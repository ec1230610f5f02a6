/// The camera: raster space <-> rays and camera space. Raster space: pixels, x right, y down, (0, 0) at the
/// top left of the whole image (not of the crop). Camera space: x right, y up, z forward.
#pragma once

#include <array>

#include "core/math.h"
#include "core/pixel_rect.h"
#include "core/rays.h"
#include "core/scene/aperture.h"

namespace trapeze {

struct Options;

/// The camera of a frame, ready for use. Its rays are the only ones that samples take.
struct Camera {
    bool perspective = true;
    int width = 0, height = 0;  ///< pixels of the whole image
    PixelRect crop;             ///< pixels to make
    float near_clip = 0, far_clip = 0;
    float lens_radius = 0;     ///< camera-space length; 0: pinhole
    float focal_distance = 1;  ///< camera-space z in focus
    Aperture aperture;         ///< the part of the lens' disk that is open
    /// The image plane: z = 1 for perspective, any z for orthographic; plane = raster * scale + offset.
    float plane_scale_x = 1, plane_offset_x = 0;
    float plane_scale_y = -1, plane_offset_y = 0;
    /// The part of the plane that fills the picture, over tan_half_fov.
    float left = -1, right = 1, bottom = -1, top = 1;
    /// The same in screen space: left right bottom top. Transformations before Projection part the two.
    std::array<float, 4> screen_window{-1, 1, -1, 1};
    float tan_half_fov = 1;

    bool has_lens() const { return lens_radius > 0; }

    /// The ray through a raster position from a point of the lens (unit disk), at a time.
    AxisRay ray(float raster_x, float raster_y, float lens_u, float lens_v, float time01) const;

    /// The raster position at which a camera-space point is seen through the middle of the lens. For
    /// perspective z must be positive.
    V2f raster_from_camera(const V3f& p) const;

    /// Half-width in pixels, along x and y, of the blur of a point at depth z; z is clamped to the near
    /// plane.
    V2f circle_of_confusion(float z) const;

    /// Pixels per camera-space length at depth z (positive for perspective).
    V2f pixels_per_length(float z) const;
};

/// The camera that the options describe: Format, FrameAspectRatio, ScreenWindow, CropWindow, Projection,
/// Clipping, DepthOfField (RISpec 4.1.1).
Camera make_camera(const Options& options);

/// The pixels whose samples reach the crop through the filter: the crop grown by half the filter's support.
/// May reach past the image.
PixelRect sampled_pixels(const Camera& camera, const Options& options);

/// The matrix (row vectors) that takes camera-space points to -1..1 across the whole picture and up it; for
/// files' metadata, and as a step to screen, NDC and raster space.
M44f screen_from_camera(const Camera& camera);

}  // namespace trapeze
