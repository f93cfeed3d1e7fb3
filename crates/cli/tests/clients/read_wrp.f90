! Reads separation.wrp, conform.wrp (over the plane or the rail) or countact.wrp, proves its order and its end, and writes what it
! has read as a stream of 8-byte reals and 4-byte integers:  read_wrp FILE OUT
!
! Stream: n_xi n_eta n_points n_cells (integers); delta, origin, xi, eta, zeta axes; xi(:), eta(:);
! m(:) (integers); s(:); normals (2, :) of CONFORM; points (3, :); cells (5, :) (integers), areas (:)
! Over the rail's surface (CONFCURV) sigma stands for xi and t for s; before the points come stations
! (xi zeta alpha n_xi n_zeta, :) and the wheel's normals (3, :).
program read_wrp
  implicit none
  integer, parameter :: dp = kind(1d0)
  character(len=8) :: magic, unit
  character(len=512) :: name
  character(len=3) :: last
  integer :: version, comments, n_xi, n_eta, n_points, n_cells, i, j, k
  integer, allocatable :: m(:,:), cell(:,:)
  real(dp) :: first(2), step(2), delta, frame(3,4), place(2)
  real(dp), allocatable :: xi(:), eta(:), s(:,:), normal(:,:,:), wheel(:,:,:), point(:,:), area(:)
  real(dp), allocatable :: station(:,:)
  real(dp) :: sigma

  call get_command_argument(1, name)
  open(10, file=name, status='old', action='read')
  read(10, '(a8,i4,1x,a8)') magic, version, unit
  if (version /= 1 .or. unit /= 'mm') error stop 'not version 1 in mm'
  if (all(magic /= ['WRPATCH ', 'CONFORM ', 'COUNTACT', 'CONFCURV'])) error stop 'unknown magic word'
  read(10, '(i8)') comments
  do k = 1, comments
    read(10, '()')
  end do
  read(10, '(2i8)') n_xi, n_eta
  read(10, '(2e25.16)') first, step
  read(10, '(e25.16)') delta
  read(10, '(3e25.16)') frame
  allocate(xi(n_xi), eta(n_eta), m(n_eta, n_xi), s(n_eta, n_xi), normal(2, n_eta, n_xi))
  allocate(station(5, n_xi), wheel(3, n_eta, n_xi))
  do i = 1, n_xi
    if (magic /= 'CONFCURV') exit
    read(10, '(3e25.16)') xi(i), station(1:2, i)
    read(10, '(3e25.16)') station(3:5, i)
  end do
  do i = 1, n_xi
    sigma = 0
    if (magic == 'CONFCURV') sigma = xi(i)
    do j = 1, n_eta
      read(10, '(i2,3e25.16)') m(j, i), place, s(j, i)
      if (magic == 'CONFORM') read(10, '(2x,2e25.16)') normal(:, j, i)
      if (magic == 'CONFCURV') read(10, '(2x,3e25.16)') wheel(:, j, i)
      if (magic == 'CONFCURV' .and. place(1) /= sigma) error stop 'a record has another sigma than its station'
      if (j == 1) xi(i) = place(1)
      if (i == 1) eta(j) = place(2)
      if (place(1) /= xi(i) .or. place(2) /= eta(j)) error stop 'records out of order'
    end do
  end do
  if (xi(1) /= first(1) .or. eta(1) /= first(2)) error stop 'first cell is elsewhere'
  if (maxval(abs(xi - first(1) - step(1) * [(k, k = 0, n_xi - 1)])) > 1e-6_dp * step(1) .or. &
      maxval(abs(eta - first(2) - step(2) * [(k, k = 0, n_eta - 1)])) > 1e-6_dp * step(2)) &
    error stop 'cells are not at equal steps'
  n_points = 0
  n_cells = 0
  if (magic == 'COUNTACT') read(10, '(2i8)') n_points, n_cells
  allocate(point(3, n_points), cell(5, n_cells), area(n_cells))
  if (n_points > 0) read(10, '(3e25.16)') point
  do k = 1, n_cells
    read(10, '(i4,4i8,e25.16)') cell(:, k), area(k)
  end do
  read(10, '(a3)') last
  if (last /= 'END') error stop 'no END line: the file was cut off'
  close(10)

  call get_command_argument(2, name)
  open(11, file=name, access='stream', form='unformatted', status='replace')
  write(11) n_xi, n_eta, n_points, n_cells, delta, frame, xi, eta, m, s
  if (magic == 'CONFORM') write(11) normal
  if (magic == 'CONFCURV') write(11) station, wheel
  write(11) point, cell, area
  close(11)
end program read_wrp
