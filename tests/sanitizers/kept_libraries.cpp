// Part of `inkwell` in sanitizer builds. At exit, LeakSanitizer searches the loaded libraries for pointers. If only an
// unloaded library, such as a Mesa driver, refers to a block of memory, the block would be reported as a leak.
// Therefore no library is unloaded.

// Name of the function in the C library.
extern "C" int dlclose(void*) { return 0; }  // NOLINT(readability-identifier-naming)
