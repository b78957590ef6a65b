// The program.

#include "app/command_line.hpp"
#include "app/exit_code.hpp"
#include "app/library_settings.hpp"
#include "mesh/read_apart.hpp"

int main(int argc, char** argv) {
  driftwright::app::restart_with_library_settings(argv);
  driftwright::app::take_threads_that_fit();
  driftwright::mesh::all_threads_are_ours();
  driftwright::app::end_with_words();
  return driftwright::app::command_line(argc, argv);
}
