# Writes a header with a hash of the sources that decide what a reduced machine is: cmake -DFOLDERS=... -DTOP=... -DBUILD=... -DOUT=... -P source_hash.cmake
# BUILD: compiler, flags and versions of libraries, which decide it too. OUT.d lists these files and their folders, so that it is made again where one is
# changed, added or removed.
set(all "${BUILD}")
set(depends "")
foreach(folder ${FOLDERS})
  string(APPEND depends " ${TOP}/${folder}")
  file(GLOB files ${TOP}/${folder}/*.cpp ${TOP}/${folder}/*.hpp)
  list(SORT files)
  foreach(file ${files})
    file(SHA256 ${file} hash)
    string(APPEND all "${hash}")
    string(APPEND depends " ${file}")
  endforeach()
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 16 hash)
file(CONFIGURE OUTPUT ${OUT} CONTENT "#pragma once
// Made by cmake/source_hash.cmake.

namespace driftwright {
inline constexpr const char* kSourcesOfMachines = \"${hash}\";
}  // namespace driftwright
")
file(WRITE ${OUT}.d "${OUT}:${depends}\n")
