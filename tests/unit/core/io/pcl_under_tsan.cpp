// OpenNI2, which PCL's reader of point files pulls in, unlocks mutexes that it does not hold when it is
// loaded: a finding of ThreadSanitizer's in every program linked with it, and none of ours.
extern "C" const char* __tsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier): its name

extern "C" const char* __tsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "mutex:libOpenNI2.so\n";
}
