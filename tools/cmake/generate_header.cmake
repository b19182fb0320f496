# Writes the output of the Python script PROGRAM for the given files to a header. ARGUMENTS come before the files. The
# script runs at configure time, so that an editor finds the header before the first build. A change of any of these
# files triggers a new configuration. A header with the same content as before keeps its time stamp.
function(inkwell_generate_header header program)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "ARGUMENTS")
  set(files ${arg_UNPARSED_ARGUMENTS})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${program} ${files})
  execute_process(COMMAND ${Python3_EXECUTABLE} ${program} ${arg_ARGUMENTS} ${files} OUTPUT_VARIABLE text
                  COMMAND_ERROR_IS_FATAL ANY)
  file(CONFIGURE OUTPUT ${header} CONTENT "${text}" @ONLY)
endfunction()
