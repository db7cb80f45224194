#include "sim/kernel.h"
