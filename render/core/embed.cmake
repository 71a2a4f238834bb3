# Writes OUTPUT, a C++ file that holds FILES (a list) as arrays: cmake -DOUTPUT=... -DFILES=a,b -P embed.cmake
string(REPLACE "," ";" FILES "${FILES}")
set(arrays "")
set(rows "")
set(number 0)
foreach(file IN LISTS FILES)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(REGEX REPLACE "(................................................................................)" "\\1\n" bytes "${bytes}")
  string(APPEND arrays "constexpr unsigned char file_${number}[] = {\n${bytes}\n0};\n")
  string(APPEND rows "    {\"${name}\", {file_${number}, sizeof file_${number} - 1}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE "${OUTPUT}" "// Generated from the files in shaders/ and the font.\n#include \"render/core/assets.h\"\n\n"
  "namespace render {\nnamespace {\n${arrays}}  // namespace\n\n"
  "const std::vector<Asset>& assets() {\n  static const std::vector<Asset> all{\n${rows}  };\n  return all;\n}\n\n"
  "}  // namespace render\n")
