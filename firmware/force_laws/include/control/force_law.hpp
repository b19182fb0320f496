// For force laws: #include <control/force_law.hpp>.
#pragma once

#include "firmware/control/signal_path/force_law.hpp"
