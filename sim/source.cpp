#include "sim/source.h"
