// A library to be loaded before a program (LD_PRELOAD) that makes one of its calls to the system
// fail. What it does stands in the environment:
//
//   FAULT_CALL     open, read, write, sync, rename, unlink, folder, size, close, memory or thread
//   FAULT_AT       which of these calls fails: the n-th, from 1
//   FAULT_ERROR    the number that errno gets; 0: the call transfers half of what it should;
//                  -1: it reads a flipped bit; -2: it reads nothing, as at the end of a file
//   FAULT_LASTS    1: all later calls fail, too, as on a full disk
//   FAULT_FOLDER   calls on files are counted only within this folder
//   FAULT_COUNTS   a file that gets a line "CALL COUNT" for each kind when the program ends
//
// Counting begins with main(). Requests of memory count from a size above a page on.

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
}

namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kDescriptors = 4096;
constexpr int kHalf = 0;
constexpr int kNothing = -2;
constexpr std::array<std::string_view, 11> kCalls = {"open",   "read",   "write",  "sync",
                                                     "rename", "unlink", "folder", "size",
                                                     "close",  "memory", "thread"};
enum Call {
  kOpen,
  kRead,
  kWrite,
  kSync,
  kRename,
  kUnlink,
  kFolder,
  kSize,
  kClose,
  kMemory,
  kThread
};

// Constant initialization only: memory is asked for before any constructor has run.
std::atomic<bool> counting = false;
std::array<std::atomic<long>, kCalls.size()> counts;
std::array<std::atomic<bool>, kDescriptors> is_ours;  // opened within the folder
std::array<std::atomic<bool>, kDescriptors> is_written;
int failing_call = -1;
long failing_at = 0;
int failing_error = 0;
bool fault_lasts = false;
std::string_view folder;
bool runs_in_folder = false;

template <typename Function>
Function* next(Function* /*type*/, const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}
/// The function of this name that the program would call without this library.
#define NEXT(name)                                   \
  ([] {                                              \
    static auto* const found = next(&(name), #name); \
    return found;                                    \
  }())

/// Counts a call. Whether it is to fail; errno is set if so.
bool fails(Call call) {
  if (!counting) return false;
  const long n = ++counts[call];
  if (call != failing_call || n < failing_at || (n > failing_at && !fault_lasts)) return false;
  if (failing_error > 0) errno = failing_error;
  return true;
}

bool within_folder(const char* path) {
  if (folder.empty()) return true;
  if (path[0] != '/') return runs_in_folder;
  return std::string_view(path).substr(0, folder.size()) == folder;
}

bool within_folder(int descriptor) {
  return descriptor >= 0 && static_cast<std::size_t>(descriptor) < kDescriptors &&
         is_ours[descriptor];
}

int opened(int descriptor, int flags) {
  if (descriptor >= 0 && static_cast<std::size_t>(descriptor) < kDescriptors) {
    is_ours[descriptor] = true;
    is_written[descriptor] = (flags & O_ACCMODE) != O_RDONLY;
  }
  return descriptor;
}

/// A read that goes wrong as failing_error tells.
template <typename Transfer>
ssize_t read_wrongly(void* buffer, std::size_t bytes, const Transfer& transfer) {
  if (failing_error > 0) return -1;
  if (failing_error == kNothing) return 0;
  if (failing_error == kHalf) return transfer(bytes > 1 ? bytes / 2 : bytes);
  const ssize_t got = transfer(bytes);
  if (got > 0) {
    const auto at = static_cast<std::size_t>(failing_at) * 7919 % static_cast<std::size_t>(got);
    static_cast<unsigned char*>(buffer)[at] ^= static_cast<unsigned char>(1U << (failing_at % 8));
  }
  return got;
}

/// Half the bytes, at least one, where a transfer is to be short; an error otherwise.
template <typename Transfer>
ssize_t fail_or_shorten(std::size_t bytes, const Transfer& transfer) {
  if (failing_error != kHalf) return -1;
  return transfer(bytes > 1 ? bytes / 2 : bytes);
}

void write_counts() {
  counting = false;
  const char* const path = std::getenv("FAULT_COUNTS");
  if (path == nullptr) return;
  std::array<char, 512> text{};
  std::size_t size = 0;
  for (std::size_t call = 0; call < kCalls.size(); ++call) {
    size +=
        static_cast<std::size_t>(std::snprintf(text.data() + size, text.size() - size, "%s %ld\n",
                                               kCalls[call].data(), counts[call].load()));
  }
  const int file = NEXT(open)(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  [[maybe_unused]] const ssize_t put = NEXT(write)(file, text.data(), size);
  NEXT(close)(file);
}

void begin_to_count() {
  const char* const call = std::getenv("FAULT_CALL");
  for (std::size_t i = 0; call != nullptr && i < kCalls.size(); ++i) {
    if (kCalls[i] == call) failing_call = static_cast<int>(i);
  }
  const auto number = [](const char* name) {
    const char* const text = std::getenv(name);
    return text == nullptr ? 0 : std::atol(text);
  };
  failing_at = number("FAULT_AT");
  failing_error = static_cast<int>(number("FAULT_ERROR"));
  fault_lasts = number("FAULT_LASTS") != 0;
  if (const char* const path = std::getenv("FAULT_FOLDER")) folder = path;
  std::array<char, PATH_MAX> here{};
  runs_in_folder = ::getcwd(here.data(), here.size()) != nullptr && folder == here.data();
  counting = true;
}

using Main = int(int, char**, char**);
Main* true_main = nullptr;

int counted_main(int count, char** arguments, char** environment) {
  begin_to_count();
  const int code = true_main(count, arguments, environment);
  write_counts();
  return code;
}

}  // namespace

extern "C" {

int __libc_start_main(Main* main, int count, char** arguments, void (*init)(), void (*fini)(),
                      void (*loader_fini)(), void* stack_end) {
  using Start = int(Main*, int, char**, void (*)(), void (*)(), void (*)(), void*);
  true_main = main;
  auto* const start = reinterpret_cast<Start*>(::dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(counted_main, count, arguments, init, fini, loader_fini, stack_end);
}

void _exit(int code) {
  write_counts();
  NEXT(_exit)(code);
  __builtin_unreachable();
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = va_arg(rest, mode_t);
  va_end(rest);
  if (!within_folder(path)) return NEXT(open)(path, flags, mode);
  if (fails(kOpen)) return -1;
  return opened(NEXT(open)(path, flags, mode), flags);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = va_arg(rest, mode_t);
  va_end(rest);
  return open(path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  if (!within_folder(path)) return NEXT(fopen)(path, mode);
  if (fails(kOpen)) return nullptr;
  FILE* const file = NEXT(fopen)(path, mode);
  if (file != nullptr) opened(fileno(file), mode[0] == 'r' && mode[1] != '+' ? O_RDONLY : O_WRONLY);
  return file;
}

FILE* fopen64(const char* path, const char* mode) { return fopen(path, mode); }

ssize_t read(int file, void* buffer, std::size_t bytes) {
  if (within_folder(file) && fails(kRead)) {
    return read_wrongly(buffer, bytes,
                        [&](std::size_t some) { return NEXT(read)(file, buffer, some); });
  }
  return NEXT(read)(file, buffer, bytes);
}

ssize_t pread(int file, void* buffer, std::size_t bytes, off_t offset) {
  if (within_folder(file) && fails(kRead)) {
    return read_wrongly(buffer, bytes,
                        [&](std::size_t some) { return NEXT(pread)(file, buffer, some, offset); });
  }
  return NEXT(pread)(file, buffer, bytes, offset);
}

ssize_t pread64(int file, void* buffer, std::size_t bytes, off64_t offset) {
  return pread(file, buffer, bytes, offset);
}

ssize_t write(int file, const void* buffer, std::size_t bytes) {
  if (within_folder(file) && fails(kWrite)) {
    return fail_or_shorten(bytes,
                           [&](std::size_t some) { return NEXT(write)(file, buffer, some); });
  }
  return NEXT(write)(file, buffer, bytes);
}

ssize_t pwrite(int file, const void* buffer, std::size_t bytes, off_t offset) {
  if (within_folder(file) && fails(kWrite)) {
    return fail_or_shorten(
        bytes, [&](std::size_t some) { return NEXT(pwrite)(file, buffer, some, offset); });
  }
  return NEXT(pwrite)(file, buffer, bytes, offset);
}

ssize_t pwrite64(int file, const void* buffer, std::size_t bytes, off64_t offset) {
  return pwrite(file, buffer, bytes, offset);
}

ssize_t writev(int file, const iovec* parts, int count) {
  if (within_folder(file) && fails(kWrite)) {
    return fail_or_shorten(count > 0 ? parts[0].iov_len : 0, [&](std::size_t some) {
      return NEXT(write)(file, parts[0].iov_base, some);
    });
  }
  return NEXT(writev)(file, parts, count);
}

std::size_t fwrite(const void* buffer, std::size_t size, std::size_t count, FILE* file) {
  // Only errors that last: short transfers are the business of stdio itself.
  const bool is_hard = failing_error > 0 && failing_error != EINTR;
  if (within_folder(fileno(file)) && is_hard && fails(kWrite)) return 0;
  return NEXT(fwrite)(buffer, size, count, file);
}

int fsync(int file) { return within_folder(file) && fails(kSync) ? -1 : NEXT(fsync)(file); }

int fdatasync(int file) { return within_folder(file) && fails(kSync) ? -1 : NEXT(fdatasync)(file); }

int rename(const char* from, const char* to) {
  return within_folder(to) && fails(kRename) ? -1 : NEXT(rename)(from, to);
}

int unlink(const char* path) {
  return within_folder(path) && fails(kUnlink) ? -1 : NEXT(unlink)(path);
}

int rmdir(const char* path) {
  return within_folder(path) && fails(kUnlink) ? -1 : NEXT(rmdir)(path);
}

int remove(const char* path) {
  return within_folder(path) && fails(kUnlink) ? -1 : NEXT(remove)(path);
}

int fallocate(int file, int mode, off_t offset, off_t size) {
  return within_folder(file) && fails(kSize) ? -1 : NEXT(fallocate)(file, mode, offset, size);
}

int fallocate64(int file, int mode, off64_t offset, off64_t size) {
  return fallocate(file, mode, offset, size);
}

int mkdir(const char* path, mode_t mode) {
  return within_folder(path) && fails(kFolder) ? -1 : NEXT(mkdir)(path, mode);
}

char* mkdtemp(char* path) {
  return within_folder(path) && fails(kFolder) ? nullptr : NEXT(mkdtemp)(path);
}

int ftruncate(int file, off_t size) {
  return within_folder(file) && fails(kSize) ? -1 : NEXT(ftruncate)(file, size);
}

int ftruncate64(int file, off64_t size) { return ftruncate(file, size); }

int close(int file) {
  if (!within_folder(file)) return NEXT(close)(file);
  const bool written = is_written[file];
  is_ours[file] = false;
  const int code = NEXT(close)(file);
  return written && fails(kClose) ? -1 : code;  // the descriptor is closed all the same
}

void* malloc(std::size_t bytes) {
  return bytes > kPage && fails(kMemory) ? nullptr : __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) {
  return count * bytes > kPage && fails(kMemory) ? nullptr : __libc_calloc(count, bytes);
}

void* realloc(void* memory, std::size_t bytes) {
  return bytes > kPage && fails(kMemory) ? nullptr : __libc_realloc(memory, bytes);
}

void* memalign(std::size_t alignment, std::size_t bytes) {
  return bytes > kPage && fails(kMemory) ? nullptr : __libc_memalign(alignment, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) { return memalign(alignment, bytes); }

int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
  void* const found = memalign(alignment, bytes);
  if (found == nullptr) return ENOMEM;
  *memory = found;
  return 0;
}

void* mmap(void* address, std::size_t bytes, int protection, int flags, int file, off_t offset) {
  if ((flags & MAP_ANONYMOUS) != 0 && bytes > kPage && fails(kMemory)) return MAP_FAILED;
  return NEXT(mmap)(address, bytes, protection, flags, file, offset);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*),
                   void* argument) {
  if (fails(kThread)) return EAGAIN;
  return NEXT(pthread_create)(thread, attributes, run, argument);
}
}
