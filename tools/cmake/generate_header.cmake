# Writes a header when the build is configured, so that an editor finds it before anything is built: what PROGRAM, in
# Python, prints of the files that follow. When one of them changes, the build is configured again.
function(inkwell_generate_header header program)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${program} ${ARGN})
  execute_process(COMMAND ${Python3_EXECUTABLE} ${program} ${ARGN} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  file(CONFIGURE OUTPUT ${header} CONTENT "${text}" @ONLY)
endfunction()
