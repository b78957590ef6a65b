# cmake -D "FILES=a;b" -D HEADER=room/texts.hpp -D "FUNCTION=room::texts" -D TYPE=Text -D OUTPUT=out.cpp -P embed_texts.cmake: the texts of files, to the
# byte, as what a function of driftwright::room returns, which HEADER declares: const std::vector<TYPE>&, a TYPE being {name, text}. -D BYTES=ON: files that are no text.
string(REGEX MATCH "^(.*)::([^:]+)$" whole ${FUNCTION})
set(room ${CMAKE_MATCH_1})
set(function ${CMAKE_MATCH_2})
set(table "")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  if(BYTES)
    file(SIZE ${file} size)
    file(READ ${file} text HEX)
    string(REGEX REPLACE "(..)" "\\\\x\\1" text "${text}")
    string(APPEND table "      {\"${name}\", std::string(\"${text}\", ${size})},\n")
  else()
    file(READ ${file} text)
    string(APPEND table "      {\"${name}\", R\"~~~(${text})~~~\"},\n")
  endif()
endforeach()
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

namespace driftwright::${room} {

const std::vector<${TYPE}>& ${function}() {
  static const std::vector<${TYPE}> files = {
${table}  };
  return files;
}

}  // namespace driftwright::${room}
")
