roscell_needs(Threads)
roscell_needs(fastcdr)
roscell_needs(fastrtps)
