# The manual page and the shells' completions, as the program prints them, and Debian's change log, compressed: documents.cmake PROGRAM FOLDER VERSION
# (cmake -D PROGRAM=... -D FOLDER=... -D VERSION=... -P)
file(MAKE_DIRECTORY ${FOLDER})
function(printed name)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE ${FOLDER}/${name} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
printed(driftwright.1 --man)
printed(driftwright.bash --completion bash)
printed(_driftwright --completion zsh)
file(WRITE ${FOLDER}/changelog "driftwright (${VERSION}) unstable; urgency=medium

  * CHANGELOG.md of the sources says what is new.

 -- The Driftwright developers <driftwright@localhost>  Sun, 29 Nov 2026 00:00:00 +0000
")
foreach(name driftwright.1 changelog)
  execute_process(COMMAND gzip -9nf ${FOLDER}/${name} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
