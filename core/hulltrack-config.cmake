# find_package(hulltrack): hulltrack::core, hulltrack::io, hulltrack::lidar. See core/README.md.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4)
find_dependency(PkgConfig)
pkg_check_modules(PCAP REQUIRED IMPORTED_TARGET libpcap)
include(${CMAKE_CURRENT_LIST_DIR}/hulltrack-targets.cmake)
