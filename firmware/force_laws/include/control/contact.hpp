// For force laws: #include <control/contact.hpp>.
#pragma once

#include "firmware/control/signal_path/contact.hpp"
