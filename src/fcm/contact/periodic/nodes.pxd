cdef class Nodes:
    cdef readonly int highest, nodes
    cdef readonly bint alone
    cdef readonly double step, first
    cdef readonly double[:, ::1] node_cos, node_sin
    cdef int few, many, before
    cdef bint fundamental
    cdef void take_nodes(self, int moving) noexcept nogil
