# Writes the bytes of INPUT into OUTPUT as the text NAME of namespace NAMESPACE. Compilers need not support the long
# string literal that would say the same.
#
#   cmake -DINPUT=FILE -DOUTPUT=FILE.cc -DNAMESPACE=ricochet -DNAME=kText -P embed.cmake
file(READ ${INPUT} hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
file(WRITE ${OUTPUT} "#include \"absl/strings/string_view.h\"\n\nnamespace ${NAMESPACE} {\n\n"
                     "static const char bytes[] = {${bytes}};\n"
                     "extern const absl::string_view ${NAME};\n"
                     "constinit const absl::string_view ${NAME}(bytes, sizeof bytes);\n\n}  // namespace ${NAMESPACE}\n")
