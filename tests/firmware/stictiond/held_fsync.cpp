// A disk that does not answer: fsync() waits as long as the file that $HELD_FSYNC names is there. To be preloaded.
#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>

extern "C" int fsync(int descriptor) {
  const char* held = std::getenv("HELD_FSYNC");
  while (held != nullptr && ::access(held, F_OK) == 0) ::usleep(1000);
  const auto next = reinterpret_cast<int (*)(int)>(::dlsym(RTLD_NEXT, "fsync"));
  return next(descriptor);
}
