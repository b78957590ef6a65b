# cmake -D FILES=a;b -D OUTPUT=out.cpp -P embed.cmake: the texts of files as a C++ table, to the byte.
set(table "")
foreach(file ${FILES})
  file(READ ${file} text)
  get_filename_component(name ${file} NAME)
  string(APPEND table "      {\"${name}\", R\"~~~(${text})~~~\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"compensation/control/control_files.hpp\"

namespace driftwright::compensation {

const std::vector<ControlFile>& control_files() {
  static const std::vector<ControlFile> files = {
${table}  };
  return files;
}

}  // namespace driftwright::compensation
")
