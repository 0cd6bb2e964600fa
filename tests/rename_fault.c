/* LD_PRELOAD for batch_test.sh: a rename to a name that holds $FAULT_AT crashes or fails. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

int rename(const char* from, const char* to) {
  const char* at = getenv("FAULT_AT");
  if (at != NULL && strstr(to, at) != NULL) {
    if (strcmp(getenv("FAULT"), "crash") == 0) raise(SIGSEGV);
    errno = EACCES;
    return -1;
  }
  int (*next)(const char*, const char*) = (int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename");
  return next(from, to);
}
