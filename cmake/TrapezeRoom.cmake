# How many sources are compiled as one: of the program, and of tests, of which more have names in common.
set(TRAPEZE_SOURCES_AT_ONCE 24)
set(TRAPEZE_TESTS_AT_ONCE 8)

# trapeze_compile_together(TARGET AT_ONCE SOURCE ...)
# AT_ONCE sources are one to the compiler, which then reads headers once for all of them: most of what it does.
# Kernels stay alone, since each of their files is compiled again for every instruction set, and so do the
# ALONE sources of a room: those that have names of their own that others have too.
function(trapeze_compile_together target at_once)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${TRAPEZE_COMPILE_TOGETHER} UNITY_BUILD_BATCH_SIZE ${at_once})
    foreach(source ${ARGN})
        if(NOT IS_ABSOLUTE ${source})
            file(STRINGS ${source} kernel REGEX "include <hwy/(foreach_target|targets).h>" LIMIT_COUNT 1)
            if(kernel)
                set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
                                            COMPILE_OPTIONS "${TRAPEZE_KERNEL_OPTIONS}")
            endif()
        endif()
    endforeach()
endfunction()

# trapeze_tests_of(PROGRAM [SHARDS]): hands a program's tests to ctest, each as a process of its own; or, where the
# program takes long to load, in so many processes, PROGRAM.0 and on, which share all tests.
function(trapeze_tests_of program)
    if(ARGC EQUAL 1)
        gtest_discover_tests(${program} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${TRAPEZE_TEST_TIMEOUT})
        return()
    endif()
    set(shards ${ARGV1})
    math(EXPR last "${shards} - 1")
    math(EXPR timeout "${TRAPEZE_TEST_TIMEOUT} * 3")
    foreach(shard RANGE ${last})
        add_test(NAME ${program}.${shard} COMMAND ${program} --gtest_brief=1)
        set_tests_properties(${program}.${shard} PROPERTIES TIMEOUT ${timeout}
                             ENVIRONMENT "GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${shard}")
    endforeach()
endfunction()

# trapeze_room_test(NAME PROGRAM TESTS LINKS [SHARDS]): a program of tests of a room.
function(trapeze_room_test name program tests links)
    add_executable(${program} ${tests})
    trapeze_compile_together(${program} ${TRAPEZE_TESTS_AT_ONCE} ${tests})
    target_compile_options(${program} PRIVATE ${TRAPEZE_TEST_OPTIMISATION})
    target_link_libraries(${program} PRIVATE trapeze_${name} ${links} GTest::gtest_main GTest::gmock)
    target_compile_definitions(${program} PRIVATE TRAPEZE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    trapeze_tests_of(${program} ${ARGN})
endfunction()

# trapeze_room(NAME SOURCES ... TESTS ... PICTURE_TESTS ... ALONE ... LINKS ... PRIVATE_LINKS ... RARELY_RUN NO_LOOPS)
# A room is one static library and, when tests are built, one test program made of the tests beside its sources; those
# that read or write pictures by OpenImageIO are a program of their own, for its 250 libraries take half a second to
# load. Includes are written from the root of the repository: #include "core/grid.h". RARELY_RUN: what the room
# does is little beside what it has done, and the compiler needs not look far. NO_LOOPS: it has none that -O3 makes
# faster, as measured.
function(trapeze_room name)
    cmake_parse_arguments(ROOM "RARELY_RUN;NO_LOOPS" "" "SOURCES;TESTS;PICTURE_TESTS;ALONE;LINKS;PRIVATE_LINKS" ${ARGN})
    set_source_files_properties(${ROOM_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    add_library(trapeze_${name} STATIC ${ROOM_SOURCES})
    trapeze_compile_together(trapeze_${name} ${TRAPEZE_SOURCES_AT_ONCE} ${ROOM_SOURCES})
    target_include_directories(trapeze_${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(trapeze_${name} PUBLIC ${ROOM_LINKS} PRIVATE ${ROOM_PRIVATE_LINKS})
    if(ROOM_RARELY_RUN)
        target_compile_options(trapeze_${name} PRIVATE ${TRAPEZE_TEST_OPTIMISATION})
    elseif(ROOM_NO_LOOPS)
        target_compile_options(trapeze_${name} PRIVATE $<$<CONFIG:Release>:-O2>)
    endif()
    if(TRAPEZE_BUILD_TESTS AND ROOM_TESTS)
        trapeze_room_test(${name} ${name}_test "${ROOM_TESTS}" "${ROOM_PRIVATE_LINKS}")
    endif()
    if(TRAPEZE_BUILD_TESTS AND ROOM_PICTURE_TESTS)
        trapeze_room_test(${name} ${name}_pictures_test "${ROOM_PICTURE_TESTS}" "${ROOM_PRIVATE_LINKS};PkgConfig::OIIO" 4)
    endif()
endfunction()
