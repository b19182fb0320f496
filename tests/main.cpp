#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#ifdef INKWELL_ON_PC
#include <cstdlib>

namespace {

/// Names that the developer has bound to arms must not change a test.
[[maybe_unused]] const int no_arm_names = setenv("INKWELL_ARMS", "", 1);

}  // namespace
#endif
