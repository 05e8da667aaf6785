// The leak check names blocks by the library that allocated them. The GL driver unloads its parts
// at exit, and what it still holds would be reported without a name: keep every library loaded.
extern "C" int dlclose(void* /*handle*/) {
    return 0;
}

// oneTBB frees an observer's 40-byte proxy only when the last worker that met it leaves.
extern "C" const char* __lsan_default_suppressions() { // NOLINT(bugprone-reserved-identifier)
    return "leak:tbb::detail::r1::observe\n";
}
