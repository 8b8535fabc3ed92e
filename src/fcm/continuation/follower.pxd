from fcm.continuation.front cimport Front
from fcm.continuation.narrow cimport Narrow
from fcm.continuation.passage cimport Passage
from fcm.continuation.place cimport Place
from fcm.continuation.problem cimport Problem
from fcm.continuation.leaving cimport Leaving
