// The source that the precompiled header is compiled for.
