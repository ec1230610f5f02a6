# cmake -DOUTPUT=FILE.cpp -DSOURCE=FOLDER -DVERSION=1.2.3 -P WriteRevision.cmake: which source is built, in words, as a
# source of its own, so that nothing else is compiled again when it changes. Without git it is the version.
find_program(GIT git)
set(revision "")
if(GIT)
    execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --tags
                    OUTPUT_VARIABLE revision ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
if(revision STREQUAL "")
    set(revision ${VERSION})
endif()
set(text "#include \"pipeline/cli/support/revision.h\"\n\nnamespace trapeze {\n\nconst char* revision() {\n    return \"${revision}\";\n}\n\n}  // namespace trapeze\n")
set(before "")
if(EXISTS ${OUTPUT})
    file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL text)
    file(WRITE ${OUTPUT} "${text}")
endif()
