#include "cad/engines.h"
