# driftwright_tests(ROOM LABEL LINKS targets... TESTS names... [WHOLE names...]): one executable ROOM_LABEL_tests of every NAME_test.cpp of this folder that is
# named, and of those that other folders have given it. Of the label unit a file is one case of CTest, ROOM/NAME, for a process takes longer to start than a
# unit test to run; so are files under WHOLE, whose cases share a long run. Cases of other files are found by CTest one by one and run side by side.
#
# driftwright_tests_linked_with(ROOM LABEL names...): gives tests of this folder to an executable of another room, because they also need what it links. That
# room's folder is added later.
#
# Labels: unit (seconds), verification (closed forms and orders of convergence), scenario (the shipped YAMLs, end to end), and long: the longest, suites
# and instances whose name ends in AtLength among them, which ./test leaves out unless it is asked for them.
include(GoogleTest)

# The suites of a test file, as --gtest_filter takes them.
function(driftwright_suites_of file filter)
  file(STRINGS ${file} lines REGEX "^(TYPED_)?TEST(_F|_P)?\\(")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  list(TRANSFORM lines REPLACE "^(TYPED_)?TEST(_F|_P)?\\(([A-Za-z0-9]+),.*" "\\3")
  list(REMOVE_DUPLICATES lines)
  if(NOT lines)
    message(FATAL_ERROR "${file} has no test that would be run as a whole")
  endif()
  list(TRANSFORM lines REPLACE "(.+)" "\\1.*:*/\\1.*:\\1/*.*")
  list(JOIN lines ":" lines)
  set(${filter} "${lines}" PARENT_SCOPE)
endfunction()

function(driftwright_tests_linked_with room label)
  if(TARGET ${room}_${label}_tests)
    message(FATAL_ERROR "tests/CMakeLists.txt must add ${CMAKE_CURRENT_SOURCE_DIR} before the folder that declares ${room}_${label}_tests")
  endif()
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  set_property(GLOBAL APPEND PROPERTY driftwright_${room}_${label}_tests ${ARGN})
endfunction()

function(driftwright_tests room label)
  cmake_parse_arguments(ARG "" "" "LINKS;TESTS;WHOLE" ${ARGN})
  set(target ${room}_${label}_tests)
  list(TRANSFORM ARG_TESTS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  list(TRANSFORM ARG_WHOLE PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  get_property(given GLOBAL PROPERTY driftwright_${target})
  list(APPEND ARG_TESTS ${given})
  if(label STREQUAL unit)
    list(APPEND ARG_WHOLE ${ARG_TESTS})
    set(ARG_TESTS "")
  endif()
  set(files ${ARG_TESTS} ${ARG_WHOLE})
  list(TRANSFORM files APPEND _test.cpp)
  add_executable(${target} ${files})
  driftwright_target(${target} HEADERS_OF driftwright_fixtures)
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  target_link_libraries(${target} PRIVATE ${ARG_LINKS} GTest::gmock GTest::gtest_main)
  # Ctest runs as many cases at once as there are cores: a second thread of one waits for the other cases. Tests of several threads set their number; unit
  # tests and those of the program run with all.
  set(alone "")
  if(label STREQUAL verification)
    set(alone ENVIRONMENT OMP_NUM_THREADS=1)
  endif()
  set(whole "")
  foreach(path ${ARG_WHOLE})
    driftwright_suites_of(${path}_test.cpp suites)
    string(APPEND whole ":${suites}")
    get_filename_component(case ${path} NAME)
    if(label STREQUAL unit)
      set(case ${room}/${case})
    endif()
    add_test(NAME ${case} COMMAND ${target} --gtest_brief=1 --gtest_filter=${suites} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${case} PROPERTIES LABELS ${label} TIMEOUT 1200 ${alone})
  endforeach()
  if(ARG_TESTS)
    gtest_discover_tests(${target} NO_PRETTY_VALUES TEST_FILTER "-*AtLength*${whole}" PROPERTIES LABELS ${label} TIMEOUT 1200 ${alone} DISCOVERY_TIMEOUT 60
                         WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    gtest_discover_tests(${target} NO_PRETTY_VALUES TEST_FILTER "*AtLength*" TEST_LIST ${target}_at_length PROPERTIES LABELS long TIMEOUT 3600
                         DISCOVERY_TIMEOUT 60 WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  endif()
endfunction()
