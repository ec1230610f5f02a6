# trapeze_module(NAME SOURCES ... CHOICE source.cpp LINKS ...)
# Adds the module NAME (core/files/module.h) of SOURCES, which use the libraries of LINKS, in three forms:
#   trapeze-NAME.so       opened at run time; in BUILD/lib/trapeze, where programs of BUILD/bin find it
#   trapeze_NAME_linked   the same code as a static library
#   trapeze_NAME          what a room links: the second, or what opens the first (TRAPEZE_MODULES)
# CHOICE is the room's function that asks for the module; TRAPEZE_LINKED_MODULES says to it which of the two it is.
function(trapeze_module name)
    cmake_parse_arguments(MODULE "" "" "SOURCES;CHOICE;LINKS" ${ARGN})
    set(code trapeze_${name}_code)
    add_library(${code} OBJECT ${MODULE_SOURCES})
    trapeze_compile_together(${code} ${MODULE_SOURCES})
    target_compile_options(${code} PRIVATE "${TRAPEZE_OPTIMISATION}")
    set_target_properties(${code} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    target_compile_definitions(${code} PRIVATE TRAPEZE_VERSION="${PROJECT_VERSION}")
    target_link_libraries(${code} PRIVATE trapeze_core ${MODULE_LINKS})

    add_library(trapeze_${name}_linked STATIC ${MODULE_CHOICE} $<TARGET_OBJECTS:${code}>)
    target_compile_definitions(trapeze_${name}_linked PRIVATE TRAPEZE_LINKED_MODULES)
    target_link_libraries(trapeze_${name}_linked PUBLIC trapeze_core PRIVATE ${MODULE_LINKS})
    if(NOT TRAPEZE_MODULES)
        add_library(trapeze_${name} ALIAS trapeze_${name}_linked)
        return()
    endif()
    add_library(trapeze_${name}_module MODULE $<TARGET_OBJECTS:${code}>)
    set_target_properties(trapeze_${name}_module PROPERTIES PREFIX "" OUTPUT_NAME trapeze-${name} LINKER_LANGUAGE CXX
        LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/trapeze)
    target_link_libraries(trapeze_${name}_module PRIVATE ${MODULE_LINKS})
    target_link_options(trapeze_${name}_module PRIVATE -Wl,-z,defs)
    add_library(trapeze_${name} STATIC ${MODULE_CHOICE})
    target_link_libraries(trapeze_${name} PUBLIC trapeze_core)
    add_dependencies(trapeze_${name} trapeze_${name}_module)
endfunction()
