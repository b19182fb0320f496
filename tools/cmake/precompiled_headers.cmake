# Third-party headers with a long parsing time, precompiled once for many targets. With ccache, set the sloppiness of
# ccache to "pch_defines,time_macros". The clang preset sets CMAKE_DISABLE_PRECOMPILE_HEADERS=ON to show whether each
# file includes the headers that it uses.

# Applies the precompiled headers of `name` to all compiled targets of a directory and its subdirectories. A target must
# link to `library` and have no precompiled headers yet. Without fmt's definitions the compiler refuses headers that
# were precompiled with fmt.
function(inkwell_use_precompiled_headers name directory library)
  get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    get_target_property(own ${target} PRECOMPILE_HEADERS_REUSE_FROM)
    get_target_property(libraries ${target} LINK_LIBRARIES)
    if(type MATCHES "STATIC_LIBRARY|EXECUTABLE" AND NOT own AND library IN_LIST libraries)
      target_precompile_headers(${target} REUSE_FROM ${name})
    endif()
  endforeach()
  get_property(subdirectories DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
  foreach(subdirectory IN LISTS subdirectories)
    inkwell_use_precompiled_headers(${name} ${subdirectory} ${library})
  endforeach()
endfunction()

find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
inkwell_add_precompiled_headers(inkwell_standard_headers
                                HEADERS <algorithm> <array> <cmath> <deque> <functional> <map> <optional> <span> <stdexcept>
                                        <string> <vector>)
set(headers <algorithm> <chrono> <filesystem> <functional> <map> <memory> <mutex> <optional> <string> <thread> <vector>
            <fmt/format.h> <nlohmann/json.hpp>)
inkwell_add_precompiled_headers(inkwell_host_headers HEADERS ${headers}
                                LIBRARIES fmt::fmt nlohmann_json::nlohmann_json)
# CLI11 generates code in every file that includes its headers, so only the commands include CLI11.
inkwell_add_precompiled_headers(inkwell_command_headers HEADERS ${headers} <CLI/CLI.hpp>
                                LIBRARIES fmt::fmt nlohmann_json::nlohmann_json CLI11::CLI11)
# Optimizing these headers takes long, and their code is not time-critical, so -O1 is sufficient. Targets must use the
# same option as their precompiled headers.
foreach(target inkwell_command_headers inkwell_command_options inkwell_command_line inkwell-lab inkwell_virtual_options)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endforeach()
inkwell_use_precompiled_headers(inkwell_command_headers ${PROJECT_SOURCE_DIR}/host/companion/command_line fmt::fmt)
foreach(directory host boards)
  inkwell_use_precompiled_headers(inkwell_command_headers ${PROJECT_SOURCE_DIR}/${directory} CLI11::CLI11)
  inkwell_use_precompiled_headers(inkwell_host_headers ${PROJECT_SOURCE_DIR}/${directory} fmt::fmt)
endforeach()
inkwell_use_precompiled_headers(inkwell_standard_headers ${PROJECT_SOURCE_DIR}/boards inkwell_warnings)
