#include "pipeline/cli/commands/compliance_notes.h"

namespace trapeze {
namespace {

constexpr RequestNote kRequests[] = {
    {"AreaLightSource",
     "sampled over all primitives up to the end of its attributes; as they move where surfaces sample motion, "
     "else where they are at shutter open"},
    {"Atmosphere", "at visible points; no volume between the surfaces that a sample of the camera sees"},
    {"Bound", "read; the renderer finds bounds itself"},
    {"Bxdf", "RIS shaders are not run: rissurface, in the Bxdf's colour or texture"},
    {"ColorSamples", "colours are turned into RGB where they are read"},
    {"Deformation", "no such shaders"},
    {"CoordSysTransform", "\"screen\", \"NDC\" and \"raster\" where the projection is orthographic"},
    {"Detail", "not within object definitions"},
    {"Displace", "read; RIS shaders are not run"},
    {"DisplayFilter", "read; RIS shaders are not run"},
    {"EditAttributeBegin", "the block is skipped"},
    {"EditBegin", "the block is skipped"},
    {"EditWorldBegin", "the block is skipped"},
    {"Exterior",
     "on rays of shaders that leave the surface, as far as the next one, or to the ray's end; where nothing is hit and "
     "there is no end it does not run"},
    {"GeometricApproximation", "motionfactor, focusfactor; flatness is read"},
    {"GeometricRepresentation", "read; all is drawn as it is"},
    {"HierarchicalSubdivisionMesh",
     "as SubdivisionMesh; edits of finer levels, which OpenSubdiv has not, are left out with one warning"},
    {"Hider",
     "hidden; others are warned about and hidden is used; aperture, jitter, depthfilter, samplemotion, "
     "maxvpdepth; "
     "minsamples and maxsamples (as a square of 4x4 at most, of 8x8 with motion or defocus) where no PixelSamples is given"},
    {"Imager",
     "over the finished picture, after filtering; s, t, u and v run from 0 to 1 over the picture; \"glow\" is "
     "built in"},
    {"Integrator", "read; RIS shaders are not run"},
    {"Interior",
     "on rays of shaders that go in or are in there, as far as the next surface, or to the ray's end; not on what the "
     "camera sees through it"},
    {"Light",
     "rislight, an area light of the shading language, stands for it; domes and distant lights are not seen; "
     "lightColorMap is for domes alone; at most 64 lights of a world shine, further ones are dark, with a warning"},
    {"LightFilter", "read, and ignored: no light is filtered"},
    {"MakeBump", "as MakeTexture"},
    {"MotionBegin",
     "any number of keys for transforms and geometry; other requests take their values as the shutter opens, "
     "with a note"},
    {"Pattern", "RIS shaders are not run: Bxdfs have the mean of its colours, or its texture"},
    {"Perspective", "read; surfaces are not transformed by projections"},
    {"PixelVariance",
     "with --variance, or a Hider whose maxsamples is above minsamples; else all pixels have all samples"},
    {"Procedural", "at once, for infinite detail; programs and libraries where the command line allows them"},
    {"Projection",
     "perspective and orthographic; of transformations before it those that scale and shift the picture, others are "
     "warned about"},
    {"Quantize", "8, 16 bits and floats, by display"},
    {"SampleFilter", "read; RIS shaders are not run"},
    {"ShaderLayer", "surface, displacement and atmosphere"},
    {"System", "never run"},
};

constexpr Capability kCapabilities[] = {
    {"Solid Modeling", "supported",
     "SolidBegin and SolidEnd with primitive, union, intersection and difference to any depth, resolved "
     "along "
     "each sample's ray: exact with motion blur and depth of field. A ray that starts inside a solid behind "
     "which an opaque surface stands is taken to start outside."},
    {"Trim Curves", "supported", "TrimCurve on NuPatch, with Attribute \"trimcurve\" \"sense\"."},
    {"Level of Detail", "supported",
     "Detail, DetailRange and RelativeDetail; levels in transition share "
     "out each pixel's samples, which together cover what one level would."},
    {"Motion Blur", "supported",
     "Transforms and deforming geometry with any number of keys, also within instances. Shading is at "
     "shutter "
     "open; parameters of shaders and lights take their values there."},
    {"Depth of Field", "supported",
     "Every sample has its own point of the lens, which may be a disk or have blades."},
    {"Special Camera Projections", "not supported", "Perspective and orthographic alone."},
    {"Displacements", "supported",
     "P is moved and normals are found again; closed surfaces stay closed. Attribute \"displacementbound\" "
     "is "
     "needed, and a shader that goes beyond it is reported with the bound that it needs. With a bound, "
     "surface shaders that set P displace, too."},
    {"Deformations", "not supported", "Deformation shaders are not run."},
    {"Spectral Colors", "supported with limits", "ColorSamples converts to three samples when RIB is read."},
    {"Programmable Shading", "supported",
     "RenderMan Shading Language 3.2: surface, displacement, light, volume and imager shaders; of RSL 2 classes that "
     "are shaders, structs and resizable arrays, without co-shaders."},
    {"Volume Shading", "supported with limits",
     "Atmosphere shaders run at visible points; there is no volume between the surfaces that a sample of the camera "
     "sees one behind the other. Interior and Exterior run along rays of shaders, from surface to surface "
     "and to the points where rays end: Interior not on what the camera sees through a surface, Exterior not on rays "
     "without an end that hit nothing."},
    {"Ray Tracing", "supported",
     "trace(), transmission() and visibility() meet all that Attribute \"visibility\" lets their rays see, at "
     "shutter open or, with Attribute \"trace\" \"samplemotion\", while it is open; gather() tells of hits. They are shaded with their own derivatives, and filtered over the width of the ray (differentials). The geometry is diced as "
     "finely as a pixel is at its distance from the eye. Solids are cut, clipping planes cut the camera's view alone. A "
     "ray looks through at most 4096 transparent surfaces. The geometry may be larger than the memory, but for the edges "
     "and vertices of its surfaces: where they do not fit into three quarters of it, what does not is left out, with an "
     "error."},
    {"Global Illumination", "supported with limits",
     "occlusion() and indirectdiffuse() send rays, or ask point clouds (\"pointbased\"); no photon maps. With point clouds "
     "walls of one layer leak: of a closed room's light 8 % with \"maxsolidangle\" 0.1, which is the default, 5 % with "
     "0.01."},
    {"Area Lights", "supported with limits",
     "AreaLightSource shines from its primitives, sampled anew at each vertex (Attribute \"light\" \"nsamples\"); "
     "\"arealight\" casts shadows of what transmission rays see. What moves shines from where it is, where Attribute "
     "\"trace\" \"samplemotion\" says so, as Bxdfs have it unless told not to. Shaders that do not look at P shine from the middle of the first primitive, with a warning."},
    {"Texture, Environment and Shadow Mapping", "supported",
     "The Make requests and what OpenImageIO reads. Numbers of 8 and 16 bits are as RISpec has them, or by the sRGB "
     "curve where Option \"color\" \"transfer\" or a \"colorspace\" asks for it (docs/colour.md). Files that do not "
     "record wrap modes are black outside; longitude 0 (+x) of environments is at the left edge, z is up; channels that "
     "a file lacks are \"fill\"."},
};

constexpr const char* kRispec[] = {"version",
                                   "Declare",
                                   "FrameBegin",
                                   "FrameEnd",
                                   "WorldBegin",
                                   "WorldEnd",
                                   "Format",
                                   "FrameAspectRatio",
                                   "ScreenWindow",
                                   "CropWindow",
                                   "Projection",
                                   "Clipping",
                                   "ClippingPlane",
                                   "DepthOfField",
                                   "Shutter",
                                   "PixelVariance",
                                   "PixelSamples",
                                   "PixelFilter",
                                   "Exposure",
                                   "Imager",
                                   "Quantize",
                                   "Display",
                                   "Hider",
                                   "ColorSamples",
                                   "RelativeDetail",
                                   "Option",
                                   "AttributeBegin",
                                   "AttributeEnd",
                                   "Color",
                                   "Opacity",
                                   "TextureCoordinates",
                                   "LightSource",
                                   "AreaLightSource",
                                   "Illuminate",
                                   "Surface",
                                   "Displacement",
                                   "Atmosphere",
                                   "Interior",
                                   "Exterior",
                                   "ShadingRate",
                                   "ShadingInterpolation",
                                   "Matte",
                                   "Bound",
                                   "Detail",
                                   "DetailRange",
                                   "GeometricApproximation",
                                   "Orientation",
                                   "ReverseOrientation",
                                   "Sides",
                                   "Identity",
                                   "Transform",
                                   "ConcatTransform",
                                   "Perspective",
                                   "Translate",
                                   "Rotate",
                                   "Scale",
                                   "Skew",
                                   "CoordinateSystem",
                                   "CoordSysTransform",
                                   "TransformBegin",
                                   "TransformEnd",
                                   "Attribute",
                                   "Polygon",
                                   "GeneralPolygon",
                                   "PointsPolygons",
                                   "PointsGeneralPolygons",
                                   "Basis",
                                   "Patch",
                                   "PatchMesh",
                                   "NuPatch",
                                   "TrimCurve",
                                   "SubdivisionMesh",
                                   "Sphere",
                                   "Cone",
                                   "Cylinder",
                                   "Hyperboloid",
                                   "Paraboloid",
                                   "Disk",
                                   "Torus",
                                   "Points",
                                   "Curves",
                                   "Blobby",
                                   "Procedural",
                                   "Geometry",
                                   "SolidBegin",
                                   "SolidEnd",
                                   "ObjectBegin",
                                   "ObjectEnd",
                                   "ObjectInstance",
                                   "MotionBegin",
                                   "MotionEnd",
                                   "MakeTexture",
                                   "MakeLatLongEnvironment",
                                   "MakeCubeFaceEnvironment",
                                   "MakeShadow",
                                   "ErrorHandler",
                                   "ReadArchive"};

constexpr RequestNote kFunctions[] = {
    {"bake3d", "PRMan's .ptc and PLY, of what the camera's picture holds"},
    {"texture3d", "point clouds; no brick maps"},
    {"indirectdiffuse", "rays, or point clouds; of a map its mean about a direction"},
    {"occlusion", "rays, for which opacities are the primitives' own, or point clouds"},
    {"rayinfo",
     "\"depth\", \"diffusedepth\", \"speculardepth\", \"shadowdepth\", \"type\", \"label\", \"origin\", "
     "\"direction\" and \"length\"; 0 for all else"},
    {"shadow", "\"raytrace\" in lights and in illuminance blocks: elsewhere a warning, and 0"},
    {"trace", "a colour, or the distance to the nearest hit"},
    {"incident", "of the Atmosphere, as atmosphere(); Interior and Exterior are not asked"},
    {"opposite", "0: Interior and Exterior are not asked"},
    {"specular", "the exponent of N.H is 8 / roughness, where RISpec writes 1 / roughness"},
    {"specularbrdf", "the exponent of N.H is 8 / roughness, where RISpec writes 1 / roughness"},
};

}  // namespace

std::span<const RequestNote> request_notes() {
    return kRequests;
}
std::span<const Capability> capabilities() {
    return kCapabilities;
}
std::span<const char* const> rispec_requests() {
    return kRispec;
}
std::span<const RequestNote> function_notes() {
    return kFunctions;
}

}  // namespace trapeze
