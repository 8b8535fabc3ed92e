from fcm.branches.surface cimport Surface
