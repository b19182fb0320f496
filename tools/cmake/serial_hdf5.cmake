# PkgConfig::hdf5, the serial HDF5 library. The parallel library would load MPI into every program that reads a
# recording, and into all programs that link to libinkwell. If both HDF5 libraries are installed, the pkg-config name of
# the serial library is hdf5-serial.
find_package(PkgConfig REQUIRED)
# HDF5 can disable file locking since version 1.10.7.
pkg_search_module(hdf5 REQUIRED IMPORTED_TARGET GLOBAL hdf5-serial>=1.10.7 hdf5>=1.10.7)
pkg_get_variable(hdf5_includedir ${hdf5_MODULE_NAME} includedir)
# On systems with two word sizes, the file name contains the word size, such as H5pubconf-64.h.
set(hdf5_configuration ${hdf5_INCLUDE_DIRS} ${hdf5_includedir})
list(TRANSFORM hdf5_configuration APPEND "/H5pubconf*.h")
file(GLOB hdf5_configuration ${hdf5_configuration})
foreach(header ${hdf5_configuration})
  file(STRINGS ${header} is_parallel REGEX "^#define H5_HAVE_PARALLEL")
  if(is_parallel)
    message(FATAL_ERROR "The HDF5 library of ${header} is a parallel build, which would load MPI into every program. "
                        "Install the serial build (Debian: the package libhdf5-dev) and configure again.")
  endif()
endforeach()
