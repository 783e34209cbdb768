# Writes the bytes of INPUT as a C++ array into OUTPUT: cmake -DINPUT=FILE -DOUTPUT=FILE.cc -P embed.cmake
file(READ ${INPUT} hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
file(WRITE ${OUTPUT} "#include \"proto/comments/commented_protos.h\"\n\nnamespace ricochet {\n\n"
                     "const unsigned char kCommentedProtos[] = {${bytes}};\n"
                     "const size_t kCommentedProtosSize = sizeof kCommentedProtos;\n\n}  // namespace ricochet\n")
