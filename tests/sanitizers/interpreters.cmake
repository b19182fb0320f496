# In sanitizer builds, `interpreter_environment` lets an interpreter without sanitizers load the libraries. The
# interpreter must load the sanitizer's library and the C++ library first. Leak detection is off, because interpreters
# leak memory at exit.
set(interpreter_environment "")
if(CMAKE_CXX_FLAGS_RELEASE MATCHES "-fsanitize=address")
  set(preloaded "")
  foreach(library IN ITEMS libasan.so libstdc++.so.6)
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=${library} OUTPUT_VARIABLE path
                    OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(APPEND preloaded "${path} ")
  endforeach()
  list(APPEND interpreter_environment "LD_PRELOAD=${preloaded}" "ASAN_OPTIONS=detect_leaks=0")
endif()
