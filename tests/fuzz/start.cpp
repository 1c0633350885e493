/// One thread, so that a run can be repeated with its seed, and small inputs do not wait for threads to wake up.
#include "batten/parallel/threads.h"

extern "C" int LLVMFuzzerInitialize(int* /*argument_count*/, char*** /*arguments*/) {
  static const batten::ThreadLimit one_thread(1);
  return 0;
}
