// Sanitizer builds of `inkwell` contain this file. At exit, LeakSanitizer searches the loaded libraries for pointers.
// LeakSanitizer reports leaks in an unloaded library, because it finds no pointers to the library's memory. This
// dlclose() does not unload any library.

// Name of the function in the C library.
extern "C" int dlclose(void*) { return 0; }  // NOLINT(readability-identifier-naming)
