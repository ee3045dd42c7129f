// SPDX-License-Identifier: Apache-2.0
// Preloaded into a program, lets chosen calls of the system fail as a full or dying disk and a short memory
// do.
//   BEAM_FAULT        KIND:N:ERRNO:COUNT  the N-th call of the kind fails, and COUNT - 1 after it
//   BEAM_FAULT_BELOW  folders, with ':' between them: only files below them are meant
//   BEAM_FAULT_BYTES  allocations of fewer bytes always succeed
//   BEAM_FAULT_TOLD   a file that gets "KIND COUNT" of every kind at the end, and a line a fault
// Kinds: alloc open create read write sync rename lock stat mkdir. Counted from the first file below the
// folders on: before that, no line of the program has run.
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* old, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
}

namespace {

enum Kind { kAlloc, kOpen, kCreate, kRead, kWrite, kSync, kRename, kLock, kStat, kMkdir, kKinds };
constexpr std::array<const char*, kKinds> kNames = {"alloc", "open",   "create", "read", "write",
                                                    "sync",  "rename", "lock",   "stat", "mkdir"};

std::array<std::atomic<long>, kKinds> calls;
std::array<std::atomic<bool>, 4096> meant;  // by descriptor
std::atomic<bool> armed{false}, ready{false};
thread_local bool inside = false;  // what the injector itself calls does not count

Kind chosen = kKinds;
long first = 0, count = 0;
int error_number = 0;
std::size_t least_bytes = 0;
char below[4096], told[4096];

__attribute__((constructor)) void begin() {
  const char* fault = ::getenv("BEAM_FAULT");
  char name[16] = {};
  if (fault && ::sscanf(fault, "%15[^:]:%ld:%d:%ld", name, &first, &error_number, &count) == 4) {
    for (int k = 0; k < kKinds; ++k)
      if (::strcmp(name, kNames[k]) == 0) chosen = static_cast<Kind>(k);
  }
  if (const char* bytes = ::getenv("BEAM_FAULT_BYTES")) least_bytes = ::strtoul(bytes, nullptr, 10);
  if (const char* folders = ::getenv("BEAM_FAULT_BELOW")) ::strncpy(below, folders, sizeof below - 1);
  if (const char* file = ::getenv("BEAM_FAULT_TOLD")) ::strncpy(told, file, sizeof told - 1);
  void* frames[2];
  ::backtrace(frames, 2);  // loads what it needs now and not inside an allocation
  ready = true;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

void tell(const char* text) {
  if (!*told) return;
  static const auto open = next<int (*)(const char*, int, ...)>("open");
  static const auto write = next<ssize_t (*)(int, const void*, std::size_t)>("write");
  const int file = open(told, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file < 0) return;
  if (write(file, text, ::strlen(text)) < 0) errno = 0;
  if (::getenv("BEAM_FAULT_TRACE") && ::strncmp(text, "fault", 5) == 0) {
    void* frames[40];
    ::backtrace_symbols_fd(frames, ::backtrace(frames, 40), file);
  }
  ::close(file);
}

__attribute__((destructor)) void end() {
  inside = true;
  for (int k = 0; k < kKinds; ++k) {
    char line[64];
    ::snprintf(line, sizeof line, "%s %ld\n", kNames[k], calls[k].load());
    tell(line);
  }
}

// GDAL, which OpenCV begins with the first picture, ends the program itself where it has no memory.
bool isOfGdal() {
  void* frames[16];
  const int found = ::backtrace(frames, 16);
  for (int f = 0; f < found; ++f) {
    Dl_info place{};
    if (::dladdr(frames[f], &place) != 0 && place.dli_fname && ::strstr(place.dli_fname, "libgdal"))
      return true;
  }
  return false;
}

bool fails(Kind kind, const char* what) {
  if (!ready || !armed || inside) return false;
  const long n = ++calls[kind];
  if (kind != chosen || n < first || n - first >= count) return false;
  inside = true;
  if (kind == kAlloc && isOfGdal()) {
    inside = false;
    return false;
  }
  char line[512];
  ::snprintf(line, sizeof line, "fault %s %ld %s\n", kNames[kind], n, what);
  tell(line);
  inside = false;
  errno = error_number;
  return true;
}

bool isBelow(const char* path) {
  if (!ready || inside || !path) return false;
  for (std::string_view rest = below; !rest.empty();) {
    const std::size_t colon = rest.find(':');
    const std::string_view folder = rest.substr(0, colon);
    rest = colon == std::string_view::npos ? std::string_view() : rest.substr(colon + 1);
    if (std::string_view(path).substr(0, folder.size()) == folder) return true;
  }
  return false;
}

void mark(int file, bool is_meant) {
  if (file >= 0 && file < static_cast<int>(meant.size())) meant[static_cast<std::size_t>(file)] = is_meant;
}
bool isMeant(int file) {
  return file >= 0 && file < static_cast<int>(meant.size()) && meant[static_cast<std::size_t>(file)];
}

template <class Call>
int opened(const char* path, int flags, Call&& call) {
  const bool is_meant = isBelow(path);
  if (is_meant) armed = true;
  if (is_meant && fails(flags & O_CREAT ? kCreate : kOpen, path)) return -1;
  const int file = call();
  mark(file, is_meant);
  return file;
}

using Open = int (*)(const char*, int, ...);
int openedBy(Open real, const char* path, int flags, va_list& more) {
  const mode_t mode = flags & O_CREAT ? static_cast<mode_t>(va_arg(more, unsigned)) : 0;
  return opened(path, flags, [&] { return real(path, flags, mode); });
}

using Control = int (*)(int, int, ...);
int controlledBy(Control real, int file, int command, va_list& more) {
  void* const argument = va_arg(more, void*);
  const bool lock = command == F_OFD_SETLK || command == F_OFD_GETLK;
  return lock && isMeant(file) && fails(kLock, "") ? -1 : real(file, command, argument);
}

}  // namespace

extern "C" {

void* malloc(std::size_t bytes) {
  return bytes >= least_bytes && fails(kAlloc, "malloc") ? nullptr : __libc_malloc(bytes);
}
void* calloc(std::size_t n, std::size_t bytes) {
  return n * bytes >= least_bytes && fails(kAlloc, "calloc") ? nullptr : __libc_calloc(n, bytes);
}
void* realloc(void* old, std::size_t bytes) {
  return bytes >= least_bytes && fails(kAlloc, "realloc") ? nullptr : __libc_realloc(old, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  return bytes >= least_bytes && fails(kAlloc, "aligned_alloc") ? nullptr : __libc_memalign(alignment, bytes);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t bytes) {
  *out =
      bytes >= least_bytes && fails(kAlloc, "posix_memalign") ? nullptr : __libc_memalign(alignment, bytes);
  return *out ? 0 : ENOMEM;
}

int open(const char* path, int flags, ...) {
  static const auto real = next<Open>("open");
  va_list more;
  va_start(more, flags);
  const int file = openedBy(real, path, flags, more);
  va_end(more);
  return file;
}
int open64(const char* path, int flags, ...) {
  static const auto real = next<Open>("open64");
  va_list more;
  va_start(more, flags);
  const int file = openedBy(real, path, flags, more);
  va_end(more);
  return file;
}
FILE* fopen(const char* path, const char* how) {
  static const auto real = next<FILE* (*)(const char*, const char*)>("fopen");
  const bool is_meant = isBelow(path);
  if (is_meant) armed = true;
  if (is_meant && fails(*how == 'r' ? kOpen : kCreate, path)) return nullptr;
  FILE* const file = real(path, how);
  if (file) mark(::fileno(file), is_meant);
  return file;
}
FILE* fopen64(const char* path, const char* how) { return fopen(path, how); }
int close(int file) {
  static const auto real = next<int (*)(int)>("close");
  mark(file, false);
  return real(file);
}
ssize_t read(int file, void* into, std::size_t bytes) {
  static const auto real = next<ssize_t (*)(int, void*, std::size_t)>("read");
  return isMeant(file) && fails(kRead, "") ? -1 : real(file, into, bytes);
}
ssize_t write(int file, const void* from, std::size_t bytes) {
  static const auto real = next<ssize_t (*)(int, const void*, std::size_t)>("write");
  return isMeant(file) && fails(kWrite, "") ? -1 : real(file, from, bytes);
}
int fsync(int file) {
  static const auto real = next<int (*)(int)>("fsync");
  return isMeant(file) && fails(kSync, "") ? -1 : real(file);
}
int fdatasync(int file) {
  static const auto real = next<int (*)(int)>("fdatasync");
  return isMeant(file) && fails(kSync, "") ? -1 : real(file);
}
int rename(const char* from, const char* to) {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return isBelow(to) && fails(kRename, to) ? -1 : real(from, to);
}
int mkdir(const char* path, mode_t mode) {
  static const auto real = next<int (*)(const char*, mode_t)>("mkdir");
  return isBelow(path) && fails(kMkdir, path) ? -1 : real(path, mode);
}
int stat(const char* path, struct stat* out) {
  static const auto real = next<int (*)(const char*, struct stat*)>("stat");
  return isBelow(path) && fails(kStat, path) ? -1 : real(path, out);
}
int fcntl(int file, int command, ...) {
  static const auto real = next<Control>("fcntl");
  va_list more;
  va_start(more, command);
  const int result = controlledBy(real, file, command, more);
  va_end(more);
  return result;
}
int fcntl64(int file, int command, ...) {
  static const auto real = next<Control>("fcntl64");
  va_list more;
  va_start(more, command);
  const int result = controlledBy(real, file, command, more);
  va_end(more);
  return result;
}

}  // extern "C"
