# Where sanitizers watch the libraries, `interpreter_environment` lets an interpreter that was built without them load them.
# The interpreter has to begin with the sanitizer's library, and with the library whose exceptions it watches. It leaks
# memory itself at its end.
set(interpreter_environment "")
if(CMAKE_CXX_FLAGS_RELEASE MATCHES "-fsanitize=address")
  set(preloaded "")
  foreach(library IN ITEMS libasan.so libstdc++.so.6)
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=${library} OUTPUT_VARIABLE place
                    OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(APPEND preloaded "${place} ")
  endforeach()
  list(APPEND interpreter_environment "LD_PRELOAD=${preloaded}" "ASAN_OPTIONS=detect_leaks=0")
endif()
