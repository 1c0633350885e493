#include "batten/render/render.h"
