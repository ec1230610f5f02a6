# cmake -DFOLDER=shade/shaders -DOUTPUT=standard_shader_texts.cpp -P EmbedShaders.cmake
# Makes a source with the names and texts of the folder's .sl files, sorted by name (see standard_shaders.cpp).
file(GLOB files "${FOLDER}/*.sl")
list(SORT files)
set(rows "")
foreach(file IN LISTS files)
    get_filename_component(name "${file}" NAME_WE)
    file(READ "${file}" text)
    string(APPEND rows "    {\"${name}\", R\"trapeze(${text})trapeze\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "#include \"shade/shaders/standard_shader_texts.h\"\n
namespace trapeze {
static constexpr StandardShaderText kTexts[] = {\n${rows}};
std::span<const StandardShaderText> standard_shader_texts() { return kTexts; }
}  // namespace trapeze\n")
