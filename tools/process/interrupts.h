#pragma once

namespace spillway::detail {

/// Makes SIGINT, SIGTERM and SIGHUP remove unfinished output files, say so on standard error (for
/// all ranks once), and end the process with exit code 128 + signal. A closed pipe and a file
/// beyond the process's size limit become failed writes, no signals. To be called once, before any
/// thread is started: all threads inherit the blocked signals, and one thread of this function
/// waits for them, so that removing files happens outside a signal handler. Throws
/// std::system_error if that thread cannot be started.
void handle_interrupts();

}  // namespace spillway::detail
