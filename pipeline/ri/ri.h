/* The RenderMan Interface 3.2 in C: link with libtrapeze.
 *
 * RiBegin(RI_NULL) renders the scene that is described up to RiEnd; RiBegin("name.rib") writes it as RIB.
 * Every call becomes one request of RIB, and is read by the same reader as files are.
 *
 * What is wrong is reported to the error handler (RiErrorPrint unless RiErrorHandler says otherwise) and left
 * out; null arguments are errors and nothing worse. Messages of the render come when it is done, within
 * RiEnd. Parameters are pairs of token and pointer to values, up to RI_NULL; a token is declared by RISpec,
 * by RiDeclare, or carries its declaration ("uniform float foo"). Values of strings are arrays of RtString,
 * integers arrays of RtInt, everything else arrays of RtFloat. The calls are for one thread at a time.
 */
#ifndef TRAPEZE_RI_H
#define TRAPEZE_RI_H

#ifdef __cplusplus
extern "C" {
#define RI_NULL nullptr
#else
#define RI_NULL ((void*)0)
#endif

typedef short RtBoolean;
typedef int RtInt;
typedef float RtFloat;
typedef const char* RtToken;
typedef RtFloat RtColor[3];
typedef RtFloat RtPoint[3];
typedef RtFloat RtVector[3];
typedef RtFloat RtNormal[3];
typedef RtFloat RtHpoint[4];
typedef RtFloat RtMatrix[4][4];
typedef RtFloat RtBasis[4][4];
typedef RtFloat RtBound[6];
typedef const char* RtString;
typedef void* RtPointer;
#define RtVoid void

typedef RtPointer RtContextHandle;
typedef RtPointer RtObjectHandle;
typedef RtPointer RtLightHandle;
typedef RtFloat (*RtFilterFunc)(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
typedef RtVoid (*RtErrorHandler)(RtInt code, RtInt severity, char* message);
typedef RtVoid (*RtProcSubdivFunc)(RtPointer data, RtFloat detail);
typedef RtVoid (*RtProcFreeFunc)(RtPointer data);
typedef RtVoid (*RtArchiveCallback)(RtToken type, char* format, ...);

#define RI_FALSE 0
#define RI_TRUE 1
#define RI_INFINITY 1.0e38f
#define RI_EPSILON 1.0e-10f

extern RtInt
    RiLastError; /* the code of the last error, whatever the handler; set it back to RIE_NOERROR yourself */

/* Tokens */
extern const RtToken RI_FRAMEBUFFER, RI_FILE, RI_RGB, RI_RGBA, RI_RGBZ, RI_RGBAZ, RI_A, RI_Z, RI_AZ;
extern const RtToken RI_PERSPECTIVE, RI_ORTHOGRAPHIC, RI_HIDDEN, RI_PAINT, RI_CONSTANT, RI_SMOOTH,
    RI_FLATNESS, RI_FOV;
extern const RtToken RI_AMBIENTLIGHT, RI_POINTLIGHT, RI_DISTANTLIGHT, RI_SPOTLIGHT;
extern const RtToken RI_INTENSITY, RI_LIGHTCOLOR, RI_FROM, RI_TO, RI_CONEANGLE, RI_CONEDELTAANGLE,
    RI_BEAMDISTRIBUTION;
extern const RtToken RI_MATTE, RI_METAL, RI_PLASTIC, RI_SHINYMETAL, RI_PAINTEDPLASTIC;
extern const RtToken RI_KA, RI_KD, RI_KS, RI_KR, RI_ROUGHNESS, RI_TEXTURENAME, RI_SPECULARCOLOR;
extern const RtToken RI_DEPTHCUE, RI_FOG, RI_BUMPY, RI_MINDISTANCE, RI_MAXDISTANCE, RI_BACKGROUND,
    RI_DISTANCE, RI_AMPLITUDE;
extern const RtToken RI_RASTER, RI_SCREEN, RI_CAMERA, RI_WORLD, RI_OBJECT;
extern const RtToken RI_INSIDE, RI_OUTSIDE, RI_LH, RI_RH;
extern const RtToken RI_P, RI_PZ, RI_PW, RI_N, RI_NP, RI_NG, RI_CI, RI_OI, RI_CS, RI_OS, RI_S, RI_T, RI_ST;
extern const RtToken RI_WIDTH, RI_CONSTANTWIDTH;
extern const RtToken RI_BILINEAR, RI_BICUBIC, RI_LINEAR, RI_CUBIC;
extern const RtToken RI_PRIMITIVE, RI_INTERSECTION, RI_UNION, RI_DIFFERENCE;
extern const RtToken RI_PERIODIC, RI_NONPERIODIC, RI_CLAMP, RI_BLACK;
extern const RtToken RI_IGNORE, RI_PRINT, RI_ABORT, RI_HANDLER;
extern const RtToken RI_ORIGIN, RI_IDENTIFIER, RI_NAME;
extern const RtToken RI_COMMENT, RI_STRUCTURE, RI_VERBATIM;
extern const RtToken RI_CATMULLCLARK, RI_HOLE, RI_CREASE, RI_CORNER, RI_INTERPOLATEBOUNDARY;

/* Bases and their steps */
extern RtBasis RiBezierBasis, RiBSplineBasis, RiCatmullRomBasis, RiHermiteBasis, RiPowerBasis;
#define RI_BEZIERSTEP ((RtInt)3)
#define RI_BSPLINESTEP ((RtInt)1)
#define RI_CATMULLROMSTEP ((RtInt)1)
#define RI_HERMITESTEP ((RtInt)2)
#define RI_POWERSTEP ((RtInt)4)

/* Errors: codes, then severities */
#define RIE_NOERROR 0
#define RIE_NOMEM 1
#define RIE_SYSTEM 2
#define RIE_NOFILE 3
#define RIE_BADFILE 4
#define RIE_VERSION 5
#define RIE_DISKFULL 6
#define RIE_INCAPABLE 11
#define RIE_OPTIONAL 11
#define RIE_UNIMPLEMENT 12
#define RIE_LIMIT 13
#define RIE_BUG 14
#define RIE_NOTSTARTED 23
#define RIE_NESTING 24
#define RIE_NOTOPTIONS 25
#define RIE_NOTATTRIBS 26
#define RIE_NOTPRIMS 27
#define RIE_ILLSTATE 28
#define RIE_BADMOTION 29
#define RIE_BADSOLID 30
#define RIE_BADTOKEN 41
#define RIE_RANGE 42
#define RIE_CONSISTENCY 43
#define RIE_BADHANDLE 44
#define RIE_NOSHADER 45
#define RIE_MISSINGDATA 46
#define RIE_SYNTAX 47
#define RIE_MATH 61

#define RIE_INFO 0
#define RIE_WARNING 1
#define RIE_ERROR 2
#define RIE_SEVERE 3

RtVoid RiErrorHandler(RtErrorHandler handler); /* may come before RiBegin; RI_NULL: RiErrorPrint */
RtVoid RiErrorIgnore(RtInt code, RtInt severity, char* message);
RtVoid RiErrorPrint(RtInt code, RtInt severity, char* message); /* on standard error */
RtVoid RiErrorAbort(RtInt code, RtInt severity, char* message); /* prints; from RIE_ERROR on, exit(1) */

/* Blocks (RISpec 3). Option "rib" "string format" "ascii" or "binary", "string compression" "none" or "gzip",
 * may come before RiBegin and hold for the files that are begun after it; names that end with .gz are packed.
 * The file appears whole at RiEnd, or not at all. */
RtVoid RiBegin(RtToken name);
RtVoid RiEnd(void);
RtContextHandle RiGetContext(void);
RtVoid RiContext(RtContextHandle handle);
RtVoid RiFrameBegin(RtInt frame);
RtVoid RiFrameEnd(void);
RtVoid RiWorldBegin(void);
RtVoid RiWorldEnd(void);
RtToken RiDeclare(RtToken name, RtToken declaration); /* the name, or RI_NULL */

/* Options (RISpec 4.1); those with parameters, and shaders, shapes and maps, are at the end */
RtVoid RiFormat(RtInt xresolution, RtInt yresolution, RtFloat pixelaspect);
RtVoid RiFrameAspectRatio(RtFloat aspect);
RtVoid RiScreenWindow(RtFloat left, RtFloat right, RtFloat bottom, RtFloat top);
RtVoid RiCropWindow(RtFloat xmin, RtFloat xmax, RtFloat ymin, RtFloat ymax);
RtVoid RiClipping(RtFloat hither, RtFloat yon);
RtVoid RiClippingPlane(RtFloat x, RtFloat y, RtFloat z, RtFloat nx, RtFloat ny, RtFloat nz);
RtVoid RiDepthOfField(RtFloat fstop, RtFloat focallength, RtFloat focaldistance);
RtVoid RiShutter(RtFloat opentime, RtFloat closetime);
RtVoid RiPixelVariance(RtFloat variance);
RtVoid RiPixelSamples(RtFloat xsamples, RtFloat ysamples);
RtVoid RiPixelFilter(RtFilterFunc filter, RtFloat xwidth, RtFloat ywidth); /* one of those below */
RtVoid RiExposure(RtFloat gain, RtFloat gamma);
RtVoid RiQuantize(RtToken type, RtInt one, RtInt min, RtInt max, RtFloat dither);
RtVoid RiColorSamples(RtInt n, RtFloat nRGB[], RtFloat RGBn[]);
RtVoid RiRelativeDetail(RtFloat relativedetail);

/* Filters: those of RISpec, then others that RIB knows by name */
RtFloat RiGaussianFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiBoxFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiTriangleFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiCatmullRomFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiSincFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiDiskFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiBesselFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiMitchellFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiBlackmanHarrisFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);

/* Attributes (RISpec 4.2). Colours have as many numbers as RiColorSamples says, 3 without. */
RtVoid RiAttributeBegin(void);
RtVoid RiAttributeEnd(void);
RtVoid RiColor(RtFloat color[]);
RtVoid RiOpacity(RtFloat opacity[]);
RtVoid RiTextureCoordinates(RtFloat s1, RtFloat t1, RtFloat s2, RtFloat t2, RtFloat s3, RtFloat t3,
                            RtFloat s4, RtFloat t4);
RtVoid RiIlluminate(RtLightHandle light, RtBoolean onoff);
RtVoid RiShadingRate(RtFloat size);
RtVoid RiShadingInterpolation(RtToken type);
RtVoid RiMatte(RtBoolean onoff);
RtVoid RiBound(RtBound bound);
RtVoid RiDetail(RtBound bound);
RtVoid RiDetailRange(RtFloat minvisible, RtFloat lowertransition, RtFloat uppertransition,
                     RtFloat maxvisible);
RtVoid RiGeometricApproximation(RtToken type, RtFloat value);
RtVoid RiGeometricRepresentation(RtToken type);
RtVoid RiOrientation(RtToken orientation);
RtVoid RiReverseOrientation(void);
RtVoid RiSides(RtInt sides);

/* Transformations (RISpec 4.3). Points are transformed in place; RI_NULL when a space is not known. */
RtVoid RiIdentity(void);
RtVoid RiTransform(RtMatrix transform);
RtVoid RiConcatTransform(RtMatrix transform);
RtVoid RiPerspective(RtFloat fov);
RtVoid RiTranslate(RtFloat dx, RtFloat dy, RtFloat dz);
RtVoid RiRotate(RtFloat angle, RtFloat dx, RtFloat dy, RtFloat dz);
RtVoid RiScale(RtFloat sx, RtFloat sy, RtFloat sz);
RtVoid RiSkew(RtFloat angle, RtFloat dx1, RtFloat dy1, RtFloat dz1, RtFloat dx2, RtFloat dy2, RtFloat dz2);
RtVoid RiCoordinateSystem(RtToken space);
RtVoid RiScopedCoordinateSystem(RtToken space);
RtVoid RiCoordSysTransform(RtToken space);
RtPoint* RiTransformPoints(RtToken fromspace, RtToken tospace, RtInt npoints, RtPoint points[]);
RtVoid RiTransformBegin(void);
RtVoid RiTransformEnd(void);

/* Geometry (RISpec 5): what its shapes depend on */
RtVoid RiBasis(RtBasis ubasis, RtInt ustep, RtBasis vbasis, RtInt vstep);
RtVoid RiTrimCurve(RtInt nloops, RtInt ncurves[], RtInt order[], RtFloat knot[], RtFloat min[], RtFloat max[],
                   RtInt n[], RtFloat u[], RtFloat v[], RtFloat w[]);

/* The functions below are known by name; another is called at once, for infinite detail. Then `freefunc` is
 * called. */
RtVoid RiProcedural(RtPointer data, RtBound bound, RtProcSubdivFunc subdivfunc, RtProcFreeFunc freefunc);
RtVoid RiProcDelayedReadArchive(RtPointer data, RtFloat detail); /* data: RtString[1] */
RtVoid RiProcRunProgram(RtPointer data, RtFloat detail);         /* data: RtString[2] */
RtVoid RiProcDynamicLoad(RtPointer data, RtFloat detail);        /* data: RtString[2] */
RtVoid RiProcFree(RtPointer data);                               /* free() */

RtVoid RiSolidBegin(RtToken operation);
RtVoid RiSolidEnd(void);
RtObjectHandle RiObjectBegin(void);
RtVoid RiObjectEnd(void);
RtVoid RiObjectInstance(RtObjectHandle handle);

/* Motion (RISpec 6): n times, as double or float in "..." */
RtVoid RiMotionBegin(RtInt n, ...);
RtVoid RiMotionBeginV(RtInt n, RtFloat times[]);
RtVoid RiMotionEnd(void);

/* Archives (RISpec 7) */
RtVoid RiArchiveRecord(RtToken type, const char* format, ...);

/* Calls with parameter lists. A row CALL(Type, Name, (parameters), (their names), the last name) is two
 * calls: Type RiName(parameters, ...);                                              pairs up to RI_NULL Type
 * RiNameV(parameters, RtInt n, RtToken tokens[], RtPointer values[]);   n pairs in two arrays */
/* clang-format off */
/* Options (RISpec 4.1) */
#define RI_OPTION_CALLS(CALL) \
    CALL(RtVoid, Projection, (RtToken name), (name), name) \
    CALL(RtVoid, Imager, (RtToken name), (name), name) \
    CALL(RtVoid, Display, (RtToken name, RtToken type, RtToken mode), (name, type, mode), mode) \
    CALL(RtVoid, DisplayChannel, (RtToken channel), (channel), channel) \
    CALL(RtVoid, Hider, (RtToken type), (type), type) \
    CALL(RtVoid, Option, (RtToken name), (name), name)

/* Lights (4.2): the handle is for RiIlluminate */
#define RI_LIGHT_CALLS(CALL) \
    CALL(RtLightHandle, LightSource, (RtToken name), (name), name) \
    CALL(RtLightHandle, AreaLightSource, (RtToken name), (name), name)

/* Shaders (4.2) */
#define RI_SHADER_CALLS(CALL) \
    CALL(RtVoid, Surface, (RtToken name), (name), name) \
    CALL(RtVoid, Displacement, (RtToken name), (name), name) \
    CALL(RtVoid, Atmosphere, (RtToken name), (name), name) \
    CALL(RtVoid, Interior, (RtToken name), (name), name) \
    CALL(RtVoid, Exterior, (RtToken name), (name), name) \
    CALL(RtVoid, Deformation, (RtToken name), (name), name)

/* Attributes (4.2) */
#define RI_ATTRIBUTE_CALLS(CALL) \
    CALL(RtVoid, Attribute, (RtToken name), (name), name)

/* Polygons, patches and subdivision meshes (5.1 to 5.3). "P" of meshes has as many points as the largest
 * index wants. */
#define RI_MESH_CALLS(CALL) \
    CALL(RtVoid, Polygon, (RtInt nvertices), (nvertices), nvertices) \
    CALL(RtVoid, GeneralPolygon, (RtInt nloops, RtInt nvertices[]), (nloops, nvertices), nvertices) \
    CALL(RtVoid, PointsPolygons, \
         (RtInt npolys, RtInt nvertices[], RtInt vertices[]), \
         (npolys, nvertices, vertices), vertices) \
    CALL(RtVoid, PointsGeneralPolygons, \
         (RtInt npolys, RtInt nloops[], RtInt nvertices[], RtInt vertices[]), \
         (npolys, nloops, nvertices, vertices), vertices) \
    CALL(RtVoid, SubdivisionMesh, \
         (RtToken scheme, RtInt nfaces, RtInt nvertices[], RtInt vertices[], RtInt ntags, \
          RtToken tags[], RtInt nargs[], RtInt intargs[], RtFloat floatargs[]), \
         (scheme, nfaces, nvertices, vertices, ntags, tags, nargs, intargs, floatargs), floatargs) \
    CALL(RtVoid, Patch, (RtToken type), (type), type) \
    CALL(RtVoid, PatchMesh, \
         (RtToken type, RtInt nu, RtToken uwrap, RtInt nv, RtToken vwrap), \
         (type, nu, uwrap, nv, vwrap), vwrap) \
    CALL(RtVoid, NuPatch, \
         (RtInt nu, RtInt uorder, RtFloat uknot[], RtFloat umin, RtFloat umax, RtInt nv, \
          RtInt vorder, RtFloat vknot[], RtFloat vmin, RtFloat vmax), \
         (nu, uorder, uknot, umin, umax, nv, vorder, vknot, vmin, vmax), vmax)

/* Quadrics (5.4) */
#define RI_QUADRIC_CALLS(CALL) \
    CALL(RtVoid, Sphere, \
         (RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax), \
         (radius, zmin, zmax, thetamax), thetamax) \
    CALL(RtVoid, Cone, \
         (RtFloat height, RtFloat radius, RtFloat thetamax), \
         (height, radius, thetamax), thetamax) \
    CALL(RtVoid, Cylinder, \
         (RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax), \
         (radius, zmin, zmax, thetamax), thetamax) \
    CALL(RtVoid, Hyperboloid, \
         (RtPoint point1, RtPoint point2, RtFloat thetamax), \
         (point1, point2, thetamax), thetamax) \
    CALL(RtVoid, Paraboloid, \
         (RtFloat rmax, RtFloat zmin, RtFloat zmax, RtFloat thetamax), \
         (rmax, zmin, zmax, thetamax), thetamax) \
    CALL(RtVoid, Disk, \
         (RtFloat height, RtFloat radius, RtFloat thetamax), \
         (height, radius, thetamax), thetamax) \
    CALL(RtVoid, Torus, \
         (RtFloat majorradius, RtFloat minorradius, RtFloat phimin, RtFloat phimax, \
          RtFloat thetamax), \
         (majorradius, minorradius, phimin, phimax, thetamax), thetamax)

/* Points, curves, implicit surfaces (5.5, 5.6), and shapes known by name */
#define RI_SHAPE_CALLS(CALL) \
    CALL(RtVoid, Points, (RtInt npoints), (npoints), npoints) \
    CALL(RtVoid, Curves, \
         (RtToken type, RtInt ncurves, RtInt nvertices[], RtToken wrap), \
         (type, ncurves, nvertices, wrap), wrap) \
    CALL(RtVoid, Blobby, \
         (RtInt nleaf, RtInt ncode, RtInt code[], RtInt nfloats, RtFloat floats[], RtInt nstrings, \
          RtString strings[]), \
         (nleaf, ncode, code, nfloats, floats, nstrings, strings), strings) \
    CALL(RtVoid, Geometry, (RtToken type), (type), type)

/* Maps (7) */
#define RI_MAP_CALLS(CALL) \
    CALL(RtVoid, MakeTexture, \
         (RtString picture, RtString texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, \
          RtFloat swidth, RtFloat twidth), \
         (picture, texture, swrap, twrap, filter, swidth, twidth), twidth) \
    CALL(RtVoid, MakeBump, \
         (RtString picture, RtString texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, \
          RtFloat swidth, RtFloat twidth), \
         (picture, texture, swrap, twrap, filter, swidth, twidth), twidth) \
    CALL(RtVoid, MakeLatLongEnvironment, \
         (RtString picture, RtString texture, RtFilterFunc filter, RtFloat swidth, RtFloat twidth), \
         (picture, texture, filter, swidth, twidth), twidth) \
    CALL(RtVoid, MakeCubeFaceEnvironment, \
         (RtString px, RtString nx, RtString py, RtString ny, RtString pz, RtString nz, \
          RtString texture, RtFloat fov, RtFilterFunc filter, RtFloat swidth, RtFloat twidth), \
         (px, nx, py, ny, pz, nz, texture, fov, filter, swidth, twidth), twidth) \
    CALL(RtVoid, MakeShadow, (RtString picture, RtString texture), (picture, texture), texture)

/* Archives (7). The callback is called within RiReadArchive, for each comment of the archive in their
 * order: with RI_COMMENT or RI_STRUCTURE, the format "%s", and the text (an RtString) behind "#" or "##".
 * The archive itself is read when the frame is rendered. */
#define RI_ARCHIVE_CALLS(CALL) \
    CALL(RtVoid, ReadArchive, \
         (RtToken name, RtArchiveCallback callback), \
         (name, callback), callback)

#define RI_CALLS(CALL) \
    RI_OPTION_CALLS(CALL) RI_LIGHT_CALLS(CALL) RI_SHADER_CALLS(CALL) RI_ATTRIBUTE_CALLS(CALL) \
    RI_MESH_CALLS(CALL) RI_QUADRIC_CALLS(CALL) RI_SHAPE_CALLS(CALL) RI_MAP_CALLS(CALL) \
    RI_ARCHIVE_CALLS(CALL)

#define RI_WITHOUT_BRACKETS(...) __VA_ARGS__
#define RI_DECLARE(Type, Name, parameters, arguments, last) \
    Type Ri##Name(RI_WITHOUT_BRACKETS parameters, ...); \
    Type Ri##Name##V(RI_WITHOUT_BRACKETS parameters, RtInt n, RtToken tokens[], RtPointer values[]);
RI_CALLS(RI_DECLARE)
/* clang-format on */

#ifdef __cplusplus
}
#endif

#endif
