// For force laws: #include <control/vector.hpp>.
#pragma once

#include "firmware/control/signal_path/vector.hpp"
