#include <control/velocity.hpp>
