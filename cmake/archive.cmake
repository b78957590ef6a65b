# `cmake --build build/package --target archive`: program and library in one file with every library that they need, for use without root; `--target wheel`: the
# Python package likewise (cmake/bundle.py). With the preset `package` for any x86-64, else the name of the file says for which processor. docs/how-to/install.md
if(Python_Interpreter_FOUND)
  add_custom_target(archive COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/bundle.py archive ${CMAKE_BINARY_DIR} ${CMAKE_BINARY_DIR}
    DEPENDS driftwright driftwright_shared documents USES_TERMINAL VERBATIM)
  if(DRIFTWRIGHT_PYTHON)
    add_custom_target(wheel COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/bundle.py wheel ${CMAKE_BINARY_DIR} ${CMAKE_BINARY_DIR}
      DEPENDS driftwright_shared driftwright_python_package USES_TERMINAL VERBATIM)
  endif()
endif()
