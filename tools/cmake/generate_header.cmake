# Writes the output of the Python script PROGRAM for the given files to a header. The script runs at configure time, so
# that an editor finds the header before the first build. A change of any of these files triggers a new configuration.
function(inkwell_generate_header header program)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${program} ${ARGN})
  execute_process(COMMAND ${Python3_EXECUTABLE} ${program} ${ARGN} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  file(CONFIGURE OUTPUT ${header} CONTENT "${text}" @ONLY)
endfunction()
