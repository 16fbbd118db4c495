# Writes OUTPUT, which defines NAME as the SHA-256 of SOURCES, between semicolons.
cmake_minimum_required(VERSION 3.25)
set(all "")
foreach(source IN LISTS SOURCES)
    file(SHA256 ${source} digest)
    string(APPEND all ${digest})
endforeach()
string(SHA256 digest "${all}")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define @NAME@ \"@digest@\"\n" @ONLY)
