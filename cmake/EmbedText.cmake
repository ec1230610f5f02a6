# cmake -DINPUT=file.css -DOUTPUT=file_css.cpp -DNAME=kFile -P EmbedText.cmake
# Makes a source with the file's text as trapeze::NAME. Long texts are cut: compilers limit a literal's length.
file(READ "${INPUT}" text)
string(LENGTH "${text}" length)
set(literals "")
set(at 0)
while(at LESS length)
    string(SUBSTRING "${text}" ${at} 8000 part)
    string(APPEND literals "    R\"trapeze(${part})trapeze\"\n")
    math(EXPR at "${at} + 8000")
endwhile()
file(WRITE "${OUTPUT}" "namespace trapeze {\nextern const char* const ${NAME};\nconst char* const ${NAME} =\n${literals};\n}  // namespace trapeze\n")
