# Locations of the files that programs need at run time, relative to the installation prefix. host/client/installation searches
# these locations, and packaging/ installs the files there.
include(GNUInstallDirs)
foreach(kind BIN LIB DATA)
  if(IS_ABSOLUTE "${CMAKE_INSTALL_${kind}DIR}")
    message(FATAL_ERROR "CMAKE_INSTALL_${kind}DIR is ${CMAKE_INSTALL_${kind}DIR}. Give a path relative to the prefix, such as "
                        "lib: an installation that is moved finds its parts relative to its programs.")
  endif()
endforeach()
set(INKWELL_PROGRAMS_PATH ${CMAKE_INSTALL_BINDIR})
set(INKWELL_ARMS_PATH ${CMAKE_INSTALL_DATADIR}/inkwell/arms)
# Programs and images are architecture-dependent, so Debian places them in lib/.
set(INKWELL_FIRMWARE_PATH lib/inkwell/firmware)
set(INKWELL_DROPINS_PATH lib/inkwell/dropins)
# Programs that only other programs start.
set(INKWELL_HELPERS_PATH lib/inkwell/helpers)

# Creates links at the same locations in the build directory, so that built programs find their files like installed
# programs. A link may be created before its target is built.
function(inkwell_link_installed_paths)
  foreach(link ${INKWELL_PROGRAMS_PATH}/virtual-board=${PROJECT_BINARY_DIR}/virtual-board
               ${INKWELL_HELPERS_PATH}/inkwell-import=${PROJECT_BINARY_DIR}/inkwell-import
               ${INKWELL_ARMS_PATH}=${PROJECT_SOURCE_DIR}/boards/arms
               ${INKWELL_FIRMWARE_PATH}=${PROJECT_BINARY_DIR}/../board
               ${INKWELL_DROPINS_PATH}=${PROJECT_BINARY_DIR}/dropins)
    string(REPLACE "=" ";" link ${link})
    list(GET link 0 path)
    list(GET link 1 part)
    cmake_path(ABSOLUTE_PATH path BASE_DIRECTORY ${PROJECT_BINARY_DIR})
    cmake_path(GET path PARENT_PATH folder)
    cmake_path(RELATIVE_PATH part BASE_DIRECTORY ${folder})
    file(MAKE_DIRECTORY ${folder})
    file(CREATE_LINK ${part} ${path} SYMBOLIC)
  endforeach()
endfunction()
inkwell_link_installed_paths()
