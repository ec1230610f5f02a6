# Embree 3, the outside reference of the sampling benchmarks; optional (CMAKE_DISABLE_FIND_PACKAGE_Embree3 leaves it out).
find_path(Embree3_INCLUDE_DIR embree3/rtcore.h)
find_library(Embree3_LIBRARY embree3)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Embree3 REQUIRED_VARS Embree3_LIBRARY Embree3_INCLUDE_DIR)
if(Embree3_FOUND AND NOT TARGET Embree3::embree3)
    add_library(Embree3::embree3 UNKNOWN IMPORTED)
    set_target_properties(Embree3::embree3 PROPERTIES
        IMPORTED_LOCATION "${Embree3_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${Embree3_INCLUDE_DIR}")
endif()
