# Debian packages: `cpack --preset pc`, or tools/packages. Each component is a package.
set(name_of_programs inkwell)
set(name_of_development inkwell-dev)
set(name_of_lab inkwell-lab)
find_program(INKWELL_GZIP gzip REQUIRED)
set(changelog ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/debian/changelog)
execute_process(COMMAND ${INKWELL_GZIP} -9nc ${CMAKE_CURRENT_SOURCE_DIR}/debian/changelog OUTPUT_FILE ${changelog} COMMAND_ERROR_IS_FATAL ANY)
foreach(component programs development lab)
  set(package ${name_of_${component}})
  # These files belong to the packages only, not to an installed build.
  install(FILES debian/copyright ${changelog} DESTINATION ${documents}/${package} COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
install(FILES debian/inkwell.lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME inkwell
        COMPONENT programs EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/../packages)
set(CPACK_POST_BUILD_SCRIPTS ${CMAKE_CURRENT_SOURCE_DIR}/checksums.cmake)
set(CPACK_INKWELL_IMAGES ${INKWELL_IMAGES})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES TRUE)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS ${CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS})
set(CPACK_PACKAGE_CONTACT "The Inkwell authors <inkwell@inkwell.invalid>")
set(CPACK_COMPONENTS_ALL programs development lab)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME inkwell)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR} ${PROJECT_BINARY_DIR}/dropins)
# libinkwell is the only library for other programs.
get_target_property(interface inkwell_library SOVERSION)
file(CONFIGURE OUTPUT shlibs CONTENT "libinkwell @interface@ inkwell (>= @PROJECT_VERSION@)\n" @ONLY)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_EXTRA
    ${CMAKE_CURRENT_BINARY_DIR}/shlibs ${CMAKE_CURRENT_SOURCE_DIR}/debian/triggers
    ${CMAKE_CURRENT_SOURCE_DIR}/debian/postinst ${CMAKE_CURRENT_SOURCE_DIR}/debian/postrm)
# Run-time dependencies: OpenGL for the window; gnuplot draws figures, and the window reads fonts.
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "libgl1")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot, fonts-inter | fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "inkwell-dev, inkwell-lab, dfu-util, openocd")
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION "companion of a haptic arm, and its virtual board
Inkwell is open firmware and host software for a haptic arm with three motors,
such as a dismantled PHANTOM Omni: one feels virtual walls with a stylus.

This package has the companion, which draws the arm, tunes and records it, in
a window and on the command line; a virtual board, which runs the very
firmware of the arm on an emulated STM32F405 beside a simulated arm; the
firmware itself; and libraries by which programs that were made for an Omni
drive the arm.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME inkwell-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "inkwell (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "library for programs that drive an Inkwell haptic arm
Inkwell is open firmware and host software for a haptic arm with three motors.

This package has what programs in C and C++ need that read the pose of the
arm, and give it forces and shapes: headers, the CMake package Inkwell, a file
for pkg-config, and examples.")

set(CPACK_DEBIAN_LAB_PACKAGE_NAME inkwell-lab)
set(CPACK_DEBIAN_LAB_PACKAGE_SECTION science)
set(CPACK_DEBIAN_LAB_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_LAB_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LAB_PACKAGE_DEPENDS "inkwell (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_LAB_DESCRIPTION "long tests of the firmware of a haptic arm
Inkwell is open firmware and host software for a haptic arm with three motors.

This package has the program inkwell-lab, which runs the firmware on virtual
boards for minutes to hours: the campaign injects each fault in each situation,
and the soak uses the boards at random and checks them continuously.")
include(CPack)
