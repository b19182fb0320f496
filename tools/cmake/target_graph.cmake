# Writes every target of the tree into target-graph.txt in the build directory: one a line, with its folder and the
# libraries that it links to, as the CMakeLists say it. The test of docs/architecture.md and tools/draw-architecture
# read it.
#
#     name|folder|library;library;...|folder of public headers;...
function(inkwell_target_lines directory result)
  get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(subdirectories DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
  cmake_path(RELATIVE_PATH directory BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE folder)
  set(lines "")
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "UTILITY")
      continue()
    endif()
    foreach(property LINK_LIBRARIES INTERFACE_LINK_LIBRARIES INTERFACE_INCLUDE_DIRECTORIES)
      get_target_property(${property} ${target} ${property})
      if(NOT ${property})
        set(${property} "")
      endif()
    endforeach()
    string(REGEX REPLACE "\\$<BUILD_INTERFACE:([^>]*)>" "\\1" INTERFACE_INCLUDE_DIRECTORIES "${INTERFACE_INCLUDE_DIRECTORIES}")
    # A library's own private ones stand in its interface once more, for the linker only.
    list(APPEND LINK_LIBRARIES ${INTERFACE_LINK_LIBRARIES})
    list(FILTER LINK_LIBRARIES EXCLUDE REGEX "LINK_ONLY")
    list(REMOVE_DUPLICATES LINK_LIBRARIES)
    string(APPEND lines "${target}|${folder}|${LINK_LIBRARIES}|${INTERFACE_INCLUDE_DIRECTORIES}\n")
  endforeach()
  foreach(subdirectory IN LISTS subdirectories)
    inkwell_target_lines(${subdirectory} more)
    string(APPEND lines "${more}")
  endforeach()
  set(${result} "${lines}" PARENT_SCOPE)
endfunction()

inkwell_target_lines(${PROJECT_SOURCE_DIR} lines)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/target-graph.txt CONTENT "${lines}" @ONLY)
