/// The calls with "...", up to RI_NULL: geometry. The V forms do the work.
#include <cstdarg>

#include "pipeline/ri/pairs.h"

using trapeze::ri::PairList;

RtVoid RiPolygon(RtInt nvertices, ...) {
    va_list rest;
    va_start(rest, nvertices);
    PairList pairs(rest);
    va_end(rest);
    RiPolygonV(nvertices, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiGeneralPolygon(RtInt nloops, RtInt nvertices[], ...) {
    va_list rest;
    va_start(rest, nvertices);
    PairList pairs(rest);
    va_end(rest);
    RiGeneralPolygonV(nloops, nvertices, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiPointsPolygons(RtInt npolys, RtInt nvertices[], RtInt vertices[], ...) {
    va_list rest;
    va_start(rest, vertices);
    PairList pairs(rest);
    va_end(rest);
    RiPointsPolygonsV(npolys, nvertices, vertices, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiPointsGeneralPolygons(RtInt npolys, RtInt nloops[], RtInt nvertices[], RtInt vertices[], ...) {
    va_list rest;
    va_start(rest, vertices);
    PairList pairs(rest);
    va_end(rest);
    RiPointsGeneralPolygonsV(npolys, nloops, nvertices, vertices, pairs.count(), pairs.tokens(),
                             pairs.values());
}

RtVoid RiSubdivisionMesh(RtToken scheme, RtInt nfaces, RtInt nvertices[], RtInt vertices[], RtInt ntags,
                         RtToken tags[], RtInt nargs[], RtInt intargs[], RtFloat floatargs[], ...) {
    va_list rest;
    va_start(rest, floatargs);
    PairList pairs(rest);
    va_end(rest);
    RiSubdivisionMeshV(scheme, nfaces, nvertices, vertices, ntags, tags, nargs, intargs, floatargs,
                       pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiPatch(RtToken type, ...) {
    va_list rest;
    va_start(rest, type);
    PairList pairs(rest);
    va_end(rest);
    RiPatchV(type, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiPatchMesh(RtToken type, RtInt nu, RtToken uwrap, RtInt nv, RtToken vwrap, ...) {
    va_list rest;
    va_start(rest, vwrap);
    PairList pairs(rest);
    va_end(rest);
    RiPatchMeshV(type, nu, uwrap, nv, vwrap, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiNuPatch(RtInt nu, RtInt uorder, RtFloat uknot[], RtFloat umin, RtFloat umax, RtInt nv, RtInt vorder,
                 RtFloat vknot[], RtFloat vmin, RtFloat vmax, ...) {
    va_list rest;
    va_start(rest, vmax);
    PairList pairs(rest);
    va_end(rest);
    RiNuPatchV(nu, uorder, uknot, umin, umax, nv, vorder, vknot, vmin, vmax, pairs.count(), pairs.tokens(),
               pairs.values());
}

RtVoid RiSphere(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, ...) {
    va_list rest;
    va_start(rest, thetamax);
    PairList pairs(rest);
    va_end(rest);
    RiSphereV(radius, zmin, zmax, thetamax, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiCone(RtFloat height, RtFloat radius, RtFloat thetamax, ...) {
    va_list rest;
    va_start(rest, thetamax);
    PairList pairs(rest);
    va_end(rest);
    RiConeV(height, radius, thetamax, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiCylinder(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, ...) {
    va_list rest;
    va_start(rest, thetamax);
    PairList pairs(rest);
    va_end(rest);
    RiCylinderV(radius, zmin, zmax, thetamax, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiHyperboloid(RtPoint point1, RtPoint point2, RtFloat thetamax, ...) {
    va_list rest;
    va_start(rest, thetamax);
    PairList pairs(rest);
    va_end(rest);
    RiHyperboloidV(point1, point2, thetamax, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiParaboloid(RtFloat rmax, RtFloat zmin, RtFloat zmax, RtFloat thetamax, ...) {
    va_list rest;
    va_start(rest, thetamax);
    PairList pairs(rest);
    va_end(rest);
    RiParaboloidV(rmax, zmin, zmax, thetamax, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiDisk(RtFloat height, RtFloat radius, RtFloat thetamax, ...) {
    va_list rest;
    va_start(rest, thetamax);
    PairList pairs(rest);
    va_end(rest);
    RiDiskV(height, radius, thetamax, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiTorus(RtFloat majorradius, RtFloat minorradius, RtFloat phimin, RtFloat phimax, RtFloat thetamax,
               ...) {
    va_list rest;
    va_start(rest, thetamax);
    PairList pairs(rest);
    va_end(rest);
    RiTorusV(majorradius, minorradius, phimin, phimax, thetamax, pairs.count(), pairs.tokens(),
             pairs.values());
}

RtVoid RiPoints(RtInt npoints, ...) {
    va_list rest;
    va_start(rest, npoints);
    PairList pairs(rest);
    va_end(rest);
    RiPointsV(npoints, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiCurves(RtToken type, RtInt ncurves, RtInt nvertices[], RtToken wrap, ...) {
    va_list rest;
    va_start(rest, wrap);
    PairList pairs(rest);
    va_end(rest);
    RiCurvesV(type, ncurves, nvertices, wrap, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiBlobby(RtInt nleaf, RtInt ncode, RtInt code[], RtInt nfloats, RtFloat floats[], RtInt nstrings,
                RtString strings[], ...) {
    va_list rest;
    va_start(rest, strings);
    PairList pairs(rest);
    va_end(rest);
    RiBlobbyV(nleaf, ncode, code, nfloats, floats, nstrings, strings, pairs.count(), pairs.tokens(),
              pairs.values());
}

RtVoid RiGeometry(RtToken type, ...) {
    va_list rest;
    va_start(rest, type);
    PairList pairs(rest);
    va_end(rest);
    RiGeometryV(type, pairs.count(), pairs.tokens(), pairs.values());
}
