// Part of `inkwell` in sanitizer builds. At exit, LeakSanitizer searches the loaded libraries for pointers. After a
// library such as a Mesa driver is unloaded, no pointers to its memory blocks are found, and LeakSanitizer reports
// leaks. Therefore no library is unloaded.

// Name of the function in the C library.
extern "C" int dlclose(void*) { return 0; }  // NOLINT(readability-identifier-naming)
