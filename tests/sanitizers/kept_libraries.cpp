// Part of `inkwell` where sanitizers watch it. At its end LeakSanitizer looks into the libraries that are loaded: what
// one that was unloaded before still points to, as Mesa's drivers do, would be a leak of nobody. So none is unloaded.

// The name is the C library's.
extern "C" int dlclose(void*) { return 0; }  // NOLINT(readability-identifier-naming)
