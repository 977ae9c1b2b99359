# FindKLU: KLU of SuiteSparse. Defines the target SuiteSparse::KLU.
include("${CMAKE_CURRENT_LIST_DIR}/SuiteSparseLibrary.cmake")
snare_find_suitesparse(KLU btf colamd amd)
