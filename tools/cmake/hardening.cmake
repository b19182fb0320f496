# Protection of all host code against memory errors: programs, shared libraries, the Python module and the Octave
# function. tests/installation/binaries.py checks the binaries.
set(INKWELL_HARDENED_COMPILE -fstack-protector-strong -fstack-clash-protection -D_GLIBCXX_ASSERTIONS)
set(INKWELL_HARDENED_LINK -Wl,-z,relro,-z,now)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|i[3-6]86)$")
  list(APPEND INKWELL_HARDENED_COMPILE -fcf-protection)
endif()
# The C library checks calls of its functions only in optimized code. In sanitizer builds, the sanitizers check the
# calls of C library functions.
string(TOUPPER "${CMAKE_BUILD_TYPE}" INKWELL_CONFIG)
set(INKWELL_CONFIG_FLAGS "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${INKWELL_CONFIG}}")
if(INKWELL_CONFIG_FLAGS MATCHES "-O([1-3sgz]|fast)" AND NOT INKWELL_CONFIG_FLAGS MATCHES "-fsanitize")
  list(APPEND INKWELL_HARDENED_COMPILE -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3)
endif()
# Targets without optimization use this option.
set(INKWELL_NOT_OPTIMIZED "SHELL:-O0 -U_FORTIFY_SOURCE")

add_compile_options(${INKWELL_HARDENED_COMPILE})
add_link_options(${INKWELL_HARDENED_LINK} $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie>)
