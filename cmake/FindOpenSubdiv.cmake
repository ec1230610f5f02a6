# Debian 12's own OpenSubdiv config names static libraries that the package leaves out.
find_path(OpenSubdiv_INCLUDE_DIR opensubdiv/bfr/refinerSurfaceFactory.h)
find_library(OpenSubdiv_CPU_LIBRARY osdCPU)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenSubdiv REQUIRED_VARS OpenSubdiv_CPU_LIBRARY OpenSubdiv_INCLUDE_DIR)
if(OpenSubdiv_FOUND AND NOT TARGET OpenSubdiv::osdCPU)
    add_library(OpenSubdiv::osdCPU UNKNOWN IMPORTED)
    set_target_properties(OpenSubdiv::osdCPU PROPERTIES
        IMPORTED_LOCATION "${OpenSubdiv_CPU_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${OpenSubdiv_INCLUDE_DIR}")
endif()
