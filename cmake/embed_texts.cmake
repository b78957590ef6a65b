# cmake -D "FILES=a;b" -D HEADER=room/texts.hpp -D "FUNCTION=room::texts" -D TYPE=Text -D OUTPUT=out.cpp -P embed_texts.cmake: the texts of files, to the
# byte, as what a function of driftwright::room returns, which HEADER declares: const std::vector<TYPE>&, a TYPE being {name, text}. -D BYTES=ON: files that are no text.
string(REGEX MATCH "^(.*)::([^:]+)$" whole ${FUNCTION})
set(room ${CMAKE_MATCH_1})
set(function ${CMAKE_MATCH_2})
set(table "")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  file(SIZE ${file} size)
  if(BYTES)
    file(READ ${file} text HEX)
    string(REGEX REPLACE "(..)" "\\\\x\\1" text "${text}")
    string(APPEND table "    {\"${name}\", ${size}, \"${text}\"},\n")
  else()
    file(READ ${file} text)
    string(APPEND table "    {\"${name}\", ${size}, R\"~~~(${text})~~~\"},\n")
  endif()
endforeach()
# Plain data and a loop: a compiler takes seconds for a list of some twenty strings.
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

namespace driftwright::${room} {

const std::vector<${TYPE}>& ${function}() {
  static const struct {
    const char* name;
    std::size_t size;
    const char* text;
  } embedded[] = {
${table}  };
  static const std::vector<${TYPE}> files = [] {
    std::vector<${TYPE}> list;
    for (const auto& file : embedded) list.push_back({file.name, std::string(file.text, file.size)});
    return list;
  }();
  return files;
}

}  // namespace driftwright::${room}
")
