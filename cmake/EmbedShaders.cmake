# cmake -DFOLDER=shade/shaders -DOUTPUT=standard_shader_texts.cpp -P EmbedShaders.cmake
# Makes a source with the names and texts of the folder's .sl files, and those of its folder include, sorted by
# name (see standard_shaders.cpp).
function(rows_of rows_name name_part)
    set(files ${ARGN})
    list(SORT files)
    set(rows "")
    foreach(file IN LISTS files)
        get_filename_component(name "${file}" ${name_part})
        file(READ "${file}" text)
        string(APPEND rows "    {\"${name}\", R\"trapeze(${text})trapeze\"},\n")
    endforeach()
    set(${rows_name} "${rows}" PARENT_SCOPE)
endfunction()

file(GLOB shaders "${FOLDER}/*.sl")
file(GLOB headers "${FOLDER}/include/*")
rows_of(shader_rows NAME_WE ${shaders})
rows_of(header_rows NAME ${headers})
file(WRITE "${OUTPUT}" "#include \"shade/shaders/standard_shader_texts.h\"\n
namespace trapeze {
static constexpr StandardShaderText kTexts[] = {\n${shader_rows}};
static constexpr StandardShaderText kHeaders[] = {\n${header_rows}};
std::span<const StandardShaderText> standard_shader_texts() { return kTexts; }
std::span<const StandardShaderText> standard_header_texts() { return kHeaders; }
}  // namespace trapeze\n")
