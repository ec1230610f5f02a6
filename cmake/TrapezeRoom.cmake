# How many sources are compiled as one.
set(TRAPEZE_SOURCES_AT_ONCE 48)

# trapeze_compile_together(TARGET SOURCE ...)
# Sources are one to the compiler, which then reads headers once for all of them: most of what it does. So names of
# their own have to differ. Kernels stay alone, since each of their files is compiled again for every instruction set.
# Precompiled headers beside this were tried, and left: 7 % less processor time (six sources, two at a time, in turns),
# while g++ 12 compiles no kernel after precompiled intrinsics (half.h includes them), and warns of the library's own.
function(trapeze_compile_together target)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${TRAPEZE_COMPILE_TOGETHER}
                                               UNITY_BUILD_BATCH_SIZE ${TRAPEZE_SOURCES_AT_ONCE})
    foreach(source ${ARGN})
        if(NOT IS_ABSOLUTE ${source})
            file(STRINGS ${source} kernel REGEX "include <hwy/(foreach_target|targets).h>" LIMIT_COUNT 1)
            if(kernel)
                set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
                                            COMPILE_OPTIONS "${TRAPEZE_KERNEL_OPTIMISATION};${TRAPEZE_KERNEL_OPTIONS}")
            endif()
        endif()
    endforeach()
endfunction()

# trapeze_tests_of(PROGRAM [PROCESSES]): hands a program's tests to ctest, in so many processes (2), PROGRAM.0 and on,
# that share them: most tests take less than a process of their own would, to load its libraries.
function(trapeze_tests_of program)
    set(processes 2)
    if(ARGC GREATER 1 AND ARGV1)
        set(processes ${ARGV1})
    endif()
    math(EXPR last "${processes} - 1")
    math(EXPR timeout "${TRAPEZE_TEST_TIMEOUT} * 3")
    foreach(process RANGE ${last})
        add_test(NAME ${program}.${process} COMMAND ${program} --gtest_brief=1)
        set_tests_properties(${program}.${process} PROPERTIES TIMEOUT ${timeout}
                             ENVIRONMENT "GTEST_TOTAL_SHARDS=${processes};GTEST_SHARD_INDEX=${process}")
    endforeach()
endfunction()

# trapeze_room_test(NAME PROGRAM TESTS LINKS PROCESSES OPTIMISATION): a program of tests of a room.
function(trapeze_room_test name program tests links processes optimisation)
    add_executable(${program} ${tests})
    trapeze_compile_together(${program} ${tests})
    target_compile_options(${program} PRIVATE ${optimisation})
    target_link_libraries(${program} PRIVATE trapeze_${name} ${links} GTest::gtest_main GTest::gmock)
    target_compile_definitions(${program} PRIVATE TRAPEZE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    trapeze_tests_of(${program} ${processes})
endfunction()

# trapeze_room(NAME SOURCES ... TESTS ... PICTURE_TESTS ... LINKS ... PRIVATE_LINKS ... PROCESSES N
#              RARELY_RUN LOOPS TESTS_COMPUTE)
# A room is one static library and, when tests are built, one test program made of the tests beside its sources; those
# that read or write pictures by OpenImageIO are a program of their own, for its 250 libraries take half a second to
# load. PROCESSES: how many share the room's tests. Includes are written from the root of the repository:
# #include "core/grid.h". RARELY_RUN: what the room does is little beside what it has done, and the compiler needs not
# look far. LOOPS: it has some, beside its kernels, that -O3 makes faster, as measured. TESTS_COMPUTE: what its tests
# wait for is in the tests, too.
function(trapeze_room name)
    cmake_parse_arguments(ROOM "RARELY_RUN;LOOPS;TESTS_COMPUTE" "PROCESSES"
                          "SOURCES;TESTS;PICTURE_TESTS;LINKS;PRIVATE_LINKS" ${ARGN})
    add_library(trapeze_${name} STATIC ${ROOM_SOURCES})
    trapeze_compile_together(trapeze_${name} ${ROOM_SOURCES})
    target_include_directories(trapeze_${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(trapeze_${name} PUBLIC ${ROOM_LINKS} PRIVATE ${ROOM_PRIVATE_LINKS})
    if(ROOM_RARELY_RUN)
        target_compile_options(trapeze_${name} PRIVATE ${TRAPEZE_RARELY_RUN_OPTIMISATION})
    elseif(NOT ROOM_LOOPS)
        target_compile_options(trapeze_${name} PRIVATE "${TRAPEZE_OPTIMISATION}")
    endif()
    set(optimisation ${TRAPEZE_TEST_OPTIMISATION})
    if(ROOM_TESTS_COMPUTE)
        set(optimisation ${TRAPEZE_COMPUTING_TEST_OPTIMISATION})
    endif()
    if(TRAPEZE_BUILD_TESTS AND ROOM_TESTS)
        trapeze_room_test(${name} ${name}_test "${ROOM_TESTS}" "${ROOM_PRIVATE_LINKS}" "${ROOM_PROCESSES}"
                          "${optimisation}")
    endif()
    if(TRAPEZE_BUILD_TESTS AND ROOM_PICTURE_TESTS)
        trapeze_room_test(${name} ${name}_pictures_test "${ROOM_PICTURE_TESTS}"
                          "${ROOM_PRIVATE_LINKS};PkgConfig::OIIO" 4 "${optimisation}")
    endif()
endfunction()
