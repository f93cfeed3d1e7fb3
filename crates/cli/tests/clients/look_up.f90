! Looks all quantities of a table up at the displacements and yaws of a file of doubles, in pairs, and writes them as doubles: look_up TABLE IN OUT
program look_up_all
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use wheelrail_table
  implicit none
  type(contact_table) :: table
  character(len=512) :: name
  double precision :: at(2)
  double precision, allocatable :: values(:)
  integer :: status
  logical :: touches
  call get_command_argument(1, name)
  call read_table(table, trim(name))
  if (quantity_number(table, 'roll_rad', 'wheelset') /= 1) error stop 'no roll'
  if (quantity_number(table, 'x', 'left') /= 0) error stop 'an unknown quantity'
  allocate(values(size(table%quantity)))
  call get_command_argument(2, name)
  open(10, file=name, access='stream', form='unformatted', status='old', action='read')
  call get_command_argument(3, name)
  open(11, file=name, access='stream', form='unformatted', status='replace')
  do
    read(10, iostat=status) at
    if (status /= 0) exit
    call look_up(table, at(1), at(2), values, touches)
    if (touches .eqv. ieee_is_nan(values(1))) error stop 'touches contradicts the values'
    write(11) values
  end do
end program
