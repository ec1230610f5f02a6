# TRAPEZE_INSTRUCTION_SETS: what kernels are compiled for. "all" is what packages and tests have; "own" is the best set
# of the machine that builds, alone: a first build of ./trapeze. On a machine without it that program says so. Plain code
# beside it, for such machines, would take a third of the time that kernels take to compile.
# Sets TRAPEZE_KERNEL_OPTIONS, the options of every file that Highway compiles once for each set.
set(TRAPEZE_INSTRUCTION_SETS all CACHE STRING "Instruction sets of kernels: all, or own: this machine's best alone")
set_property(CACHE TRAPEZE_INSTRUCTION_SETS PROPERTY STRINGS all own)

# AVX-512, AVX2, SSE4, NEON and what every machine has; nothing here gains by the targets between.
set(TRAPEZE_NO_TARGETS "HWY_AVX3_DL|HWY_SSSE3|HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128")
add_compile_definitions("HWY_DISABLED_TARGETS=(${TRAPEZE_NO_TARGETS})")

# trapeze_options_of_set(SET RESULT): what compiles kernels for one of Highway's x86 sets (AVX3, AVX2, SSE4) alone.
# Highway takes the set for one that every machine has, and so compiles no other beside it. Only functions of kernels
# use it, not what compilers make of the standard library's templates in those files.
function(trapeze_options_of_set set result)
    set(others HWY_AVX3 HWY_AVX2 HWY_SSE4)
    list(REMOVE_ITEM others HWY_${set})
    list(JOIN others "|" others)
    set(${result} -UHWY_DISABLED_TARGETS "-DHWY_DISABLED_TARGETS=(${TRAPEZE_NO_TARGETS}|${others})"
                  -DHWY_BASELINE_TARGETS=HWY_${set} PARENT_SCOPE)
endfunction()

set(TRAPEZE_KERNEL_OPTIONS "")
if(TRAPEZE_INSTRUCTION_SETS STREQUAL "own" AND NOT CMAKE_CROSSCOMPILING)
    if(NOT DEFINED TRAPEZE_OWN_INSTRUCTION_SET)
        try_run(runs compiles ${CMAKE_BINARY_DIR}/own_instruction_set
                ${CMAKE_CURRENT_LIST_DIR}/own_instruction_set.cpp
                LINK_LIBRARIES hwy::hwy RUN_OUTPUT_VARIABLE own)
        if(compiles AND runs EQUAL 0)
            set(TRAPEZE_OWN_INSTRUCTION_SET ${own} CACHE INTERNAL "Highway's name of it; nothing: not known")
        else()
            set(TRAPEZE_OWN_INSTRUCTION_SET "" CACHE INTERNAL "")
        endif()
    endif()
    if(TRAPEZE_OWN_INSTRUCTION_SET)
        trapeze_options_of_set(${TRAPEZE_OWN_INSTRUCTION_SET} TRAPEZE_KERNEL_OPTIONS)
    endif()
elseif(NOT TRAPEZE_INSTRUCTION_SETS MATCHES "^(all|own)$")
    message(FATAL_ERROR "TRAPEZE_INSTRUCTION_SETS is \"${TRAPEZE_INSTRUCTION_SETS}\": it is all or own")
endif()
