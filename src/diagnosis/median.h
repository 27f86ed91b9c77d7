#include "data/median.h"
