#include <control/current_loop.hpp>
