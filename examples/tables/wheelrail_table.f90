! Reads contact tables, `table.wrp` of `wheelrail table`, and looks contact up in them. Fortran 2008.
!
!     type(contact_table) :: table
!     call read_table(table, 'table.wrp')
!     radius = quantity_number(table, 'rolling_radius_mm', 'right')
!     call look_up(table, 2.5d0, 0.002d0, values, touches)    ! values(size(table%quantity))
!
! Lengths in mm, angles in rad; see the comments at the head of each table.
module wheelrail_table
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  implicit none
  private
  public :: contact_table, read_table, quantity_number, look_up

  integer, parameter :: dp = kind(1d0), n_coefficients = 9, n_yaw_coefficients = 5

  type :: table_quantity
    character(len=18) :: name
    character(len=8) :: side            ! wheelset, left, right
    integer :: needs                    ! 0 contact, 1 curvatures, 2 ellipse
    real(dp) :: tolerance, error        ! in the unit of the quantity
  end type

  type :: table_curve
    integer :: kind = 3                 ! 0 smooth, 1 joint, 2 hop, 3 edge
    real(dp) :: yaw(2) = 0              ! rad
    real(dp) :: c(n_yaw_coefficients) = 0   ! mm: lateral displacement over u, from -1 to 1 between the yaws
  end type

  type :: table_fork
    integer :: part(2) = 0              ! below, above: n > 0 is fork n, n < 0 is cell -n
    integer :: curve = 0                ! 0 where a yaw divides
    real(dp) :: yaw = 0
  end type

  type :: contact_table
    real(dp) :: from, to, yaw(2), radius, tolerance
    real(dp) :: beside_curves                      ! mm from curves within which values may be the other side's
    type(table_quantity), allocatable :: quantity(:)
    type(table_curve), allocatable :: curve(:)
    type(table_fork), allocatable :: fork(:)
    integer :: forks
    integer, allocatable :: flags(:,:)             ! touches, begins, lacks left, lacks right, curves at both ends; cell
    real(dp), allocatable :: yaws(:,:)             ! from, to; cell
    real(dp), allocatable :: coefficients(:,:,:,:) ! quantity, power, power of the yaw, cell
  end type

contains

  subroutine read_table(table, path)
    type(contact_table), intent(out) :: table
    character(len=*), intent(in) :: path
    character(len=8) :: magic, unit
    character(len=3) :: last
    integer :: file, version, comments, n_cells, n_quantities, n_powers, n_yaw, n_curves, c, q, j
    logical :: over_yaw
    real(dp) :: powers(n_coefficients), ends(2)
    open(newunit=file, file=path, status='old', action='read')
    read(file, '(a8,i4,1x,a8)') magic, version, unit
    if (magic /= 'WRTABLE' .or. version < 1 .or. version > 2 .or. unit /= 'mm') error stop 'not version 1 or 2 of a table in mm'
    over_yaw = version == 2
    read(file, '(i8)') comments
    do c = 1, comments
      read(file, '()')
    end do
    if (over_yaw) then
      read(file, '(6i8)') n_cells, n_quantities, n_powers, n_yaw, n_curves, table%forks
      if (n_yaw /= n_yaw_coefficients) error stop 'another number of coefficients'
    else
      read(file, '(3i8)') n_cells, n_quantities, n_powers
      n_yaw = 1
      n_curves = n_cells + 1
      table%forks = 0
    end if
    if (n_powers /= n_coefficients) error stop 'another number of coefficients'
    read(file, '(2e25.16)') table%from, table%to
    if (over_yaw) then
      read(file, '(2e25.16)') table%yaw
      read(file, '(3e25.16)') table%radius, table%tolerance, table%beside_curves
    else
      read(file, '(3e25.16)') table%yaw(1), table%radius, table%tolerance
      table%yaw(2) = table%yaw(1)
      table%beside_curves = 1d-9
    end if
    allocate(table%quantity(n_quantities), table%flags(6, n_cells), table%yaws(2, n_cells))
    allocate(table%curve(n_curves), table%fork(max(table%forks, n_cells)))
    allocate(table%coefficients(n_quantities, n_coefficients, n_yaw, n_cells))
    do q = 1, n_quantities
      associate (quantity => table%quantity(q))
        read(file, '(a18,i2,1x,a8,2e25.16)') quantity%name, quantity%needs, quantity%side, quantity%tolerance, quantity%error
      end associate
    end do
    if (over_yaw) call read_tree(table, file, n_cells)
    table%coefficients = ieee_value(0d0, ieee_quiet_nan)
    do c = 1, n_cells
      if (over_yaw) then
        read(file, '(4i2,2i8,2e25.16)') table%flags(:, c), table%yaws(:, c)
        if (any(table%flags(5:6, c) < 1 .or. table%flags(5:6, c) > n_curves)) error stop 'a cell at an unknown curve'
      else
        read(file, '(4i2,2e25.16)') table%flags(1:4, c), ends
        table%flags(5:6, c) = [c, c + 1]
        table%yaws(:, c) = table%yaw
        if (c > 1) then
          if (ends(1) < table%curve(c)%c(1)) error stop 'cells out of order'
        end if
        table%curve(c)%kind = table%flags(2, c)
        table%curve(c)%c(1) = ends(1)
        table%curve(c + 1)%c(1) = ends(2)
      end if
      if (table%flags(1, c) == 0) cycle
      do q = 1, n_quantities
        do j = 1, n_yaw
          read(file, '(3e25.16)') powers
          if (exists(table, c, q)) table%coefficients(q, :, j, c) = powers
        end do
      end do
    end do
    if (.not. over_yaw .and. n_cells > 1) call add_row(table, 1, n_cells, j)
    read(file, '(a3)') last
    if (last /= 'END') error stop 'no END line: the file was cut off'
    close(file)
  end subroutine

  ! Reads the curves and forks of a table over yaw.
  subroutine read_tree(table, file, n_cells)
    type(contact_table), intent(inout) :: table
    integer, intent(in) :: file, n_cells
    integer :: k
    do k = 1, size(table%curve)
      read(file, '(i8,2e25.16)') table%curve(k)%kind, table%curve(k)%yaw
      read(file, '(3e25.16)') table%curve(k)%c
    end do
    do k = 1, table%forks
      associate (fork => table%fork(k))
        read(file, '(3i8,e25.16)') fork%part, fork%curve, fork%yaw
        if (fork%curve < 0 .or. fork%curve > size(table%curve)) error stop 'a fork at an unknown curve'
        ! Parts of a fork come behind it, so that every way ends.
        if (any(fork%part == 0 .or. fork%part > table%forks .or. -fork%part > n_cells)) error stop 'a fork to nowhere'
        if (any(fork%part > 0 .and. fork%part <= k)) error stop 'a fork to nowhere'
      end associate
    end do
  end subroutine

  ! Adds the forks between cells in a row, each of which begins at the curve with its number; number is that of the part.
  recursive subroutine add_row(table, first, last, number)
    type(contact_table), intent(inout) :: table
    integer, intent(in) :: first, last
    integer, intent(out) :: number
    integer :: middle, fork
    if (first == last) then
      number = -first
      return
    end if
    table%forks = table%forks + 1
    fork = table%forks
    middle = first + (last - first + 1) / 2
    table%fork(fork)%curve = middle
    call add_row(table, first, middle - 1, number)
    table%fork(fork)%part(1) = number
    call add_row(table, middle, last, number)
    table%fork(fork)%part(2) = number
    number = fork
  end subroutine

  ! Whether a quantity exists over a cell in which both wheels touch.
  logical function exists(table, cell, q)
    type(contact_table), intent(in) :: table
    integer, intent(in) :: cell, q
    integer :: lacks
    select case (table%quantity(q)%side)
    case ('left')
      lacks = table%flags(3, cell)
    case ('right')
      lacks = table%flags(4, cell)
    case default
      lacks = 0
    end select
    exists = table%quantity(q)%needs + lacks <= 2
  end function

  ! The number of a quantity of 'wheelset', 'left' or 'right'; 0 of an unknown one.
  integer function quantity_number(table, name, side)
    type(contact_table), intent(in) :: table
    character(len=*), intent(in) :: name, side
    integer :: q
    quantity_number = 0
    do q = 1, size(table%quantity)
      if (table%quantity(q)%name == name .and. table%quantity(q)%side == side) quantity_number = q
    end do
  end function

  ! Where a value is between two others: -1 to 1; 0 if they are equal or out of order.
  pure real(dp) function share(ends, value)
    real(dp), intent(in) :: ends(2), value
    share = 0
    if (ends(2) > ends(1)) share = ((value - ends(1)) - (ends(2) - value)) / (ends(2) - ends(1))
  end function

  pure real(dp) function curve_at(curve, yaw)
    type(table_curve), intent(in) :: curve
    real(dp), intent(in) :: yaw
    integer :: j
    real(dp) :: u
    u = share(curve%yaw, yaw)
    curve_at = curve%c(n_yaw_coefficients)
    do j = n_yaw_coefficients - 1, 1, -1
      curve_at = curve_at * u + curve%c(j)
    end do
  end function

  ! All quantities at a lateral displacement, mm, and a yaw, rad; NaN for what does not exist and outside the range. A table under one
  ! yaw has that yaw only. touches: whether both wheels do.
  subroutine look_up(table, lateral, yaw, values, touches)
    type(contact_table), intent(in) :: table
    real(dp), intent(in) :: lateral, yaw
    real(dp), intent(out) :: values(:)
    logical, intent(out) :: touches
    integer :: part, cell, j, k
    logical :: above
    real(dp) :: t, u, sums(size(table%quantity), n_coefficients)
    touches = .false.
    if (.not. (lateral >= table%from .and. lateral <= table%to .and. yaw >= table%yaw(1) .and. yaw <= table%yaw(2))) then
      values = ieee_value(0d0, ieee_quiet_nan)
      return
    end if
    part = merge(1, -1, table%forks > 0)
    do while (part > 0)
      if (table%fork(part)%curve > 0) then
        above = lateral >= curve_at(table%curve(table%fork(part)%curve), yaw)
      else
        above = yaw >= table%fork(part)%yaw
      end if
      part = table%fork(part)%part(merge(2, 1, above))
    end do
    cell = -part
    t = share([curve_at(table%curve(table%flags(5, cell)), yaw), curve_at(table%curve(table%flags(6, cell)), yaw)], lateral)
    t = max(-1d0, min(1d0, t))
    u = share(table%yaws(:, cell), yaw)
    sums = table%coefficients(:, :, size(table%coefficients, 3), cell)
    do j = size(table%coefficients, 3) - 1, 1, -1
      sums = sums * u + table%coefficients(:, :, j, cell)
    end do
    values = sums(:, n_coefficients)
    do k = n_coefficients - 1, 1, -1
      values = values * t + sums(:, k)
    end do
    touches = table%flags(1, cell) == 1
  end subroutine

end module
