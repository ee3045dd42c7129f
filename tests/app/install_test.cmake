# Installs the command line into an empty prefix and runs it there. BUILD: the build folder, PREFIX: where to.
cmake_minimum_required(VERSION 3.22)
file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} --component beam
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
foreach(file bin/beam share/beam-studio/resources/recipes/standard.json
    share/bash-completion/completions/beam share/zsh/site-functions/_beam)
  if(NOT EXISTS ${PREFIX}/${file})
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()
execute_process(COMMAND ${PREFIX}/bin/beam version --verbose OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
if(NOT said MATCHES "resources: [^\n]*/installed/share/beam-studio/resources")
  message(FATAL_ERROR "the installed program does not use its own resources:\n${said}")
endif()
execute_process(COMMAND ${PREFIX}/bin/beam stages OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${PREFIX})
